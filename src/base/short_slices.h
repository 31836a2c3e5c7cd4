#pragma once

namespace gpu_planning_scene::core
{
/// Lets the calling thread run soon after each time it is woken, also while other threads use all cores. For threads
/// that wait for a device and give it work: the device rests while they wait for a core.
///
/// Linux since 6.12 mostly prefers a woken thread with shorter time slices to the running one. Otherwise, the woken
/// thread waits until the running one loses the core, for some milliseconds. Nothing changes in earlier kernels, and
/// for threads with another policy or a negative nice value. Threads that the thread creates have slices as usual, and
/// its requests of uclamp are not theirs.
///
/// EEVDF: I. Stoica, H. Abdel-Wahab: Earliest eligible virtual deadline first. Old Dominion University, TR-95-22, 1995.
void runInShortSlices();
}  // namespace gpu_planning_scene::core
