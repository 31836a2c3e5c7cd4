// Writes the indirect arguments of `groups` work groups to the counters from place `at` on. OpenGL grants
// MAX_GROUPS work groups along x; more of them are spread over y.
void setGroups(uint at, uint groups)
{
  const uint rows = (groups + MAX_GROUPS - 1u) / MAX_GROUPS;
  counters[at] = rows == 0u ? 0u : (groups + rows - 1u) / rows;
  counters[at + 1u] = rows;
  counters[at + 2u] = 1u;
}
