// crown_water.glsl - what of a crown's sheet is film, bead or nothing at a pixel. The film has a rim, fingers rise from
// that, holes open in the film where it is thin, and what is left between them are rods of water that break into drops.
//
// Positions on the sheet are in m: x around, y up. Beads are water thick enough to be a lens: rods and balls. The water
// of each is known (shared/crown_sheet.h), so their radii follow.

// Distance out of its face (m, < 0 inside), the direction out of it, and its radius there (m).
struct Bead {
    float out_m;
    vec2 outward;
    float radius;
};

// For loops of a few turns. Software Vulkan's compiler takes seconds for each loop that is left in a shader as long as
// this one.
#extension GL_EXT_control_flow_attributes : require
#define UNROLLED [[unroll]]

struct Sheet { // of the whole crown
    float height, radius; // m, of the rim; around at this pixel
    float share, life_s;
    float thick, rim;     // m, mean thickness of the wall; radius of the rim
    float finger_m3;      // mean water of a finger
    float fingers;        // 0: no fingers and no holes
    vec2 cells;           // holes around and up
    vec2 away;            // the part of the view's direction that is along the sheet, see seen_length
    uint random;
};

struct Film {
    float below_rim, beside_hole; // m, distance within the film from its edges
    Bead bead;
};

#define SITE_HASH   32u
#define FINGER_HASH 6u

Bead no_bead() { return Bead(1e3, vec2(0.0, 1.0), 1e-6); }

// Balls and rods are round from everywhere, though the sheet that they are drawn on is seen aslant. So distances from
// them are as the eye sees them: without the part along the line of sight, |p|^2 - (p d)^2.
Bead ball(Sheet s, vec2 p, float radius)
{
    const float along = dot(p, s.away), far = sqrt(max(dot(p, p) - along * along, 1e-18));
    return Bead(far - radius, normalize(p - along * s.away + 1e-12), radius);
}

// A rod along a line at a distance `beside` in the direction `across`. That is the least of the above on the line.
Bead rod(Sheet s, float beside, vec2 across, float radius)
{
    const float aslant = dot(across, s.away), seen = inversesqrt(1.0 + aslant * aslant / (1.0 - dot(s.away, s.away)));
    return Bead(abs(beside) * seen - radius, across * sign(beside), radius);
}

// Both as one body, with a fillet. The minimum and the directions stay smooth.
Bead join(Bead a, Bead b, float fillet)
{
    const float t = clamp(0.5 + 0.5 * (b.out_m - a.out_m) / max(fillet, 1e-9), 0.0, 1.0);
    return Bead(mix(b.out_m, a.out_m, t) - fillet * t * (1.0 - t), mix(b.outward, a.outward, t),
                mix(b.radius, a.radius, t));
}

Bead between(Bead a, Bead b, float t)
{
    return Bead(mix(a.out_m, b.out_m, t), mix(a.outward, b.outward, t), mix(a.radius, b.radius, t));
}

// How far a rod has broken into drops `age_s` after it became one.
float broken(float radius, float age_s) { return smoothstep(0.3, 1.0, age_s / virga_crown_breaks(max(radius, 1e-5))); }

// ---- rim and fingers

// Height of the rim's middle, and its slope.
struct Line {
    float y, slope;
};

// The rim comes free of the wall when holes have eaten what is below it. Of a crown that is thick there it never does.
float rim_free_s(Sheet s, float hole_m)
{
    const float opens = virga_crown_opens(virga_crown_profile(0.9) * s.thick / virga_crown_thinning(s.share), hole_m);
    return opens < 1.0 ? (s.share - max(opens, 0.3)) * s.life_s : 0.0;
}

struct Finger {
    float angle, water_m3, lean;
};

// The k-th finger. Two at a time share their water in an uneven way, so that all of them have what there is.
Finger finger_of(Sheet s, float k)
{
    const float i = k - s.fingers * floor(k / s.fingers);
    const vec4 own = unpackUnorm4x8(virga_hash3(s.random, FINGER_HASH, uint(i)));
    const vec4 pair = unpackUnorm4x8(virga_hash3(s.random, FINGER_HASH + 1u, uint(i) >> 1));
    const float more = ((uint(i) & 1u) == 0u) == (pair.y > 0.5) ? 0.95 * sqrt(pair.x) : -0.95 * sqrt(pair.x);
    return Finger((k + 0.5 + 0.6 * (own.x - 0.5)) * 6.2831853 / s.fingers, (1.0 + more) * s.finger_m3,
                  0.7 * (own.y - 0.5));
}

#define CUSP      0.13 // height of a mean cusp over that of the crown
#define CUSP_WIDE 0.3  // its width over the distance of fingers

// Slow waves that go around, and their slope with the angle.
vec2 slow_waves(Sheet s, float angle)
{
    const float phase = 6.2831853 * virga_unit(virga_hash2(s.random, 5u)), two = 2.0 * angle + phase,
                three = 3.0 * angle - phase;
    return vec2(0.92 + 0.04 * sin(two) + 0.02 * sin(three), 0.08 * cos(two) + 0.06 * cos(three));
}

float cusp_of(Sheet s, Finger f, float round)
{
    const float wide = CUSP_WIDE * 6.2831853 / s.fingers * s.radius;
    return CUSP * sqrt(f.water_m3 / s.finger_m3) * exp(-round / wide);
}

// Towards each finger the rim rises in a cusp, the higher the more water runs up there.
Line rim_line(Sheet s, float angle)
{
    if (s.fingers <= 0.0)
        return Line(s.height, 0.0);
    const vec2 slow = slow_waves(s, angle);
    Line line = Line(slow.x, slow.y / s.radius);
    const float spacing = 6.2831853 / s.fingers * s.radius, nearest = floor(angle * s.fingers / 6.2831853);
    UNROLLED for (int i = -1; i <= 1; i++) {
        const Finger f = finger_of(s, nearest + float(i));
        const float x = (angle - f.angle) * s.radius, round = sqrt(x * x + 0.3 * s.rim * s.rim);
        const float cusp = cusp_of(s, f, round);
        line.y += cusp;
        line.slope -= cusp * x / (round * CUSP_WIDE * spacing);
    }
    return Line(s.height * line.y, s.height * line.slope);
}

// Where a finger stands.
float finger_foot(Sheet s, Finger f)
{
    return s.height * (slow_waves(s, f.angle).x + cusp_of(s, f, 0.55 * s.rim));
}

// `p`: from the middle of the rim where the finger stands.
Bead finger_bead(Sheet s, Finger f, vec2 p, float parted)
{
    const float reach = max(s.height * (VIRGA_CROWN_REACH - 1.1) - s.rim, 0.0);
    const float length_m = virga_crown_finger(f.water_m3, s.rim, reach);
    const float y = clamp(p.y, 0.0, length_m), along = y / max(length_m, 1e-7);
    const vec2 axis = vec2(f.lean * y, y), tip = vec2(f.lean * length_m, length_m);
    const float radius = virga_crown_tapers(f.water_m3, length_m, along);
    Bead body = ball(s, p - axis, radius);
    body = between(body, ball(s, p - 0.45 * tip, virga_crown_ball((1.0 - VIRGA_CROWN_TIP) * f.water_m3)), parted);
    return join(body, ball(s, p - tip, virga_crown_ball(VIRGA_CROWN_TIP * f.water_m3)), 0.5 * radius * (1.0 - parted));
}

Bead edge_bead(Sheet s, Line line, float angle, float y, float hole_m)
{
    const float up = y - line.y, steep = inversesqrt(1.0 + line.slope * line.slope);
    const Bead rim = rod(s, up * steep, vec2(-line.slope, 1.0) * steep, s.rim);
    if (s.fingers <= 0.0)
        return rim;
    // Not everywhere at once.
    const float late = 0.7 + 0.3 * sin(2.0 * angle + float(s.random & 63u)), free_s = late * rim_free_s(s, hole_m);
    const float parted = broken(s.rim, free_s);
    const float nearest = floor(angle * s.fingers / 6.2831853), spacing = 6.2831853 / s.fingers * s.radius;
    const float drop = virga_crown_ball(VIRGA_CROWN_PI * s.rim * s.rim * spacing);
    Bead fingers = no_bead(), drops = no_bead();
    UNROLLED for (int i = -1; i <= 1; i++) {
        const Finger f = finger_of(s, nearest + float(i));
        const vec2 p = vec2((angle - f.angle) * s.radius, y - finger_foot(s, f));
        drops = join(drops, ball(s, p, drop), 0.2 * s.rim);
        fingers = join(fingers, finger_bead(s, f, p, parted), 0.5 * s.rim);
    }
    return join(between(rim, drops, parted), fingers, 1.5 * s.rim * (1.0 - parted));
}

// ---- holes

struct Site {
    vec2 at;      // from the pixel (m)
    float radius; // of the hole (m); 0: it has not opened
    float thick;  // of the wall there (m)
};

// One site in each cell of a grid. The hole opens where and when the wall is thinner than the site's own limit, and its
// edge retracts as that of any sheet. Below the rim and at the foot there are none.
Site site_of(Sheet s, vec2 cell, vec2 here, float hole_m)
{
    const float column = cell.x - s.cells.x * floor(cell.x / s.cells.x);
    const vec4 own = unpackUnorm4x8(virga_hash3(s.random, SITE_HASH + uint(cell.y), uint(column)));
    const vec2 at = cell + 0.5 + 0.8 * (own.xy - 0.5);
    const float thick = virga_crown_profile(at.y / s.cells.y) * s.thick;
    const float opens = virga_crown_opens(thick / virga_crown_thinning(s.share), hole_m * (0.6 + 0.8 * own.z));
    const float open_s = opens < 1.0 ? max(s.share - opens, 0.0) * s.life_s : 0.0;
    return Site((at - here) * vec2(6.2831853 * s.radius / s.cells.x, s.height / s.cells.y),
                open_s * virga_crown_retracts(thick), thick);
}

// Holes that meet leave a rod between them. Along the line halfway between two sites each hole has swept a triangle,
// so the rod's section is the wall's thickness times a quarter of the distance of the sites, for each of the two holes
// that has come so far. The rod then breaks into drops at the wavelength that grows fastest.
Bead rod_between(Sheet s, Site a, Site b)
{
    const vec2 way = b.at - a.at;
    const float apart = max(length(way), 1e-7);
    const vec2 across = way / apart, along = vec2(-across.y, across.x), middle = 0.5 * (a.at + b.at);
    const float beside = dot(middle, across), t = -dot(middle, along);
    const float from_site = length(vec2(0.5 * apart, t)), past_a = a.radius - from_site, past_b = b.radius - from_site;
    const float holes = step(0.0, past_a) + step(0.0, past_b), thick = 0.5 * (a.thick + b.thick);
    if (holes <= 0.0)
        return no_bead();
    const float radius = virga_crown_rod(0.25 * thick * apart * holes);
    const float age_s = max(past_a, past_b) / virga_crown_retracts(thick);
    const float parted = holes > 1.5 ? broken(radius, age_s) : 0.0;
    const float wave = VIRGA_CROWN_WAVE * radius, x = (fract(t / wave + 0.5) - 0.5) * wave;
    const vec2 p = along * x - across * beside;
    const Bead drop = ball(s, p, virga_crown_ball(VIRGA_CROWN_PI * radius * radius * wave));
    return between(rod(s, -beside, across, radius), drop, parted);
}

// The film at a pixel: within the hole of the nearest site there is none. Its edge gathers what the hole has swept,
// half the radius times the thickness for each length of it.
Film torn_film(Sheet s, Line line, float angle, float y, float hole_m)
{
    Film film = Film(line.y - y, 1e3, no_bead());
    if (s.fingers <= 0.0 || hole_m <= 0.0)
        return film;
    // The wall flutters, so what holes leave is not straight.
    const vec2 cell_here = vec2(angle / 6.2831853 * s.cells.x, y / s.height * s.cells.y);
    const float phase = float(s.random & 255u);
    const vec2 here = cell_here + 0.13 * sin(4.0 * cell_here.yx + vec2(phase, 1.7 * phase)), own = floor(here);
    // The two nearest sites of the nine around, with their distances.
    vec4 nearest = vec4(vec2(1e2), 0.0, s.thick), next = nearest;
    float nearest_m = 1e2, next_m = 1e2;
    UNROLLED for (int i = 0; i < 9; i++) {
        const vec2 cell = own + vec2(i % 3, i / 3) - 1.0;
        const Site site = site_of(s, cell, here, hole_m);
        const vec4 found = vec4(site.at, site.radius, site.thick);
        const float far_m = cell.y < 0.0 || cell.y >= s.cells.y ? 1e2 : length(site.at);
        const bool first = far_m < nearest_m, second = far_m < next_m;
        next = first ? nearest : second ? found : next;
        next_m = first ? nearest_m : second ? far_m : next_m;
        nearest = first ? found : nearest;
        nearest_m = first ? far_m : nearest_m;
    }
    const Site first = Site(nearest.xy, nearest.z, nearest.w), second = Site(next.xy, next.z, next.w);
    const float away = length(first.at);
    film.beside_hole = first.radius > 0.0 ? away - first.radius : 1e3;
    const float edge = virga_crown_rod(0.5 * first.thick * first.radius);
    if (first.radius > 0.0 && away > 1e-9)
        film.bead = Bead(abs(film.beside_hole) - edge, -first.at / away * sign(film.beside_hole), edge);
    film.bead = join(film.bead, rod_between(s, first, second), 0.5 * edge);
    if (film.below_rim < 0.0)
        film.bead = no_bead();
    return film;
}
