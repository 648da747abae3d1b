// wall_map.glsl - how a host's material reads what driving rain makes of walls (virga/walls.h). For GLSL hosts: include
// it after wall_gpu.h, or port it. Upload virga_walls.rows, and look up the rows that a surface's normal is between.

// The three rows of a surface and their weights, which add up to 1, or less where it faces down.
struct virga_wall_look {
    uvec3 rows; // two sides and VIRGA_WALL_LEVEL
    vec3 weights;
};

// `n`: unit normal in the world. What leans is between the side that it faces and level, by the square of the cosine.
virga_wall_look virga_wall_rows(vec3 n)
{
    const float turn = atan(n.z, n.x) * (float(VIRGA_WALL_SIDES) / 6.28318531) + float(VIRGA_WALL_SIDES);
    const float low = floor(turn), t = turn - low;
    const float level = n.y > 0.0 ? n.y * n.y : 0.0;
    const float under = smoothstep(-0.4, -0.1, n.y); // no rain hits what faces down
    virga_wall_look look;
    look.rows = uvec3(uint(low) % uint(VIRGA_WALL_SIDES), (uint(low) + 1u) % uint(VIRGA_WALL_SIDES),
                      uint(VIRGA_WALL_LEVEL));
    look.weights = under * vec3((1.0 - level) * (1.0 - t), (1.0 - level) * t, level);
    return look;
}

// The slant of the rain that reaches a wall, for a test of shelter: a slant of the distribution that virga_walls gives
// (`off`: in standard deviations), turned so far that it comes from before the wall and not through it. A point p of
// the wall is sheltered from that rain if anything is on the line p + h (-slant.x, 1, -slant.y) for some h > 0.
vec2 virga_wall_slant(vec2 mean, float spread, vec2 off, vec3 n)
{
    const vec2 slant = mean + spread * off;
    const float steep = max(length(n.xz), 1e-3);
    const vec2 out_of_wall = n.xz / steep;
    return slant - out_of_wall * max(dot(slant, out_of_wall) + 0.02, 0.0) * step(abs(n.y), 0.7);
}
