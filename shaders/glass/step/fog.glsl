// fog.glsl - condensation: fog on cells. Include it after pane.glsl and counters.glsl.
//
// A pane that can fog has a word for each cell behind its film: the fog there, in picolitres. A nanolitre on a cell of
// 2 mm is a quarter of a micrometre, which is visible, so fog has a finer unit than all other water. Fog that drops,
// blades or the film take counts in whole nanolitres; what is left of less than one dries. So both budgets close:
//     condensed = fog + dried + 1000 given        (pl)
//     landed + touched + given = drops + ...      (nl)

uint fog_word(uint cell) { return cell_count() + cell; }

#define PL_OF_NL 1000u

// Sums of a workgroup: given (nl) and dried (pl). A cell of 10 mm under 40 mm of water has less than 2^32 pl, but 256
// of them do not, so a sum of picolitres is two words: millions and the rest.
shared uint fog_given, fog_dried[2];

void begin_fog_sums()
{
    if (gl_LocalInvocationIndex == 0u)
        fog_given = fog_dried[0] = fog_dried[1] = 0u;
    barrier();
}

void add_dried(uint pl)
{
    atomicAdd(fog_dried[0], pl % 1000000u);
    if (pl >= 1000000u)
        atomicAdd(fog_dried[1], pl / 1000000u);
}

// Takes all fog off a cell, and returns it in whole nanolitres.
uint take_fog(uint cell)
{
    const uint here = film[fog_word(cell)];
    if (here == 0u)
        return 0u;
    film[fog_word(cell)] = 0u;
    add_dried(here % PL_OF_NL);
    atomicAdd(fog_given, here / PL_OF_NL);
    return here / PL_OF_NL;
}

// Counts an amount of some millions and a rest.
void count_pl(uint index, uint millions, uint rest)
{
    count(index, rest);
    uint high, low;
    umulExtended(millions, 1000000u, high, low);
    count(index, low);
    if (high != 0u)
        atomicAdd(state.counts[index].high, high);
}

void end_fog_sums()
{
    barrier();
    if (gl_LocalInvocationIndex != 0u)
        return;
    count(VIRGA_GLASS_FOG_GIVEN, fog_given);
    count_pl(VIRGA_GLASS_FOG_DRIED, fog_dried[1], fog_dried[0]);
}
