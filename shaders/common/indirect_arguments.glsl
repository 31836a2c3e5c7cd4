// Indirect arguments among the counters; more than 65535 workgroups are spread over y.
void setGroups(uint at, uint groups)
{
  const uint rows = (groups + 65534u) / 65535u;
  counters[at] = rows == 0u ? 0u : (groups + rows - 1u) / rows;
  counters[at + 1u] = rows;
  counters[at + 2u] = 1u;
}
