/* water/solver_wait.c - waits until the host can read the solver's particles. */
#include "water_state.h"

bool water_wait_for_solver(shot *s, const water_solver *solver, char *error, size_t error_size)
{
    if (!host_wait(&s->device, error, error_size))
        return false;
    host_buffer_invalidate(&s->device, &solver->before);
    host_buffer_invalidate(&s->device, &solver->now);
    return true;
}
