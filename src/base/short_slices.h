#pragma once

namespace gpu_planning_scene::core
{
/// Lets the calling thread run soon after each time it is woken, also while other threads use all cores. For threads
/// that wait for a device and give it work: they run for short times, and the device rests while they wait for a core.
///
/// Linux since 6.12 gives a thread with shorter time slices than the running one the core at once. Without this, a
/// woken thread waits until a slice of 2.8 ms ends. Earlier kernels and real-time threads are left as they are. The
/// thread keeps its nice value. Threads that it creates have slices as usual.
///
/// EEVDF: I. Stoica, H. Abdel-Wahab: Earliest eligible virtual deadline first. Old Dominion University, TR-95-22, 1995.
void runInShortSlices();
}  // namespace gpu_planning_scene::core
