#pragma once

namespace gpu_planning_scene::core
{
/// Lets the calling thread run soon after each time it is woken, also while other threads use all cores. For threads
/// that wait for a device and give it work: the device rests while they wait for a core.
///
/// Linux since 6.12 mostly prefers a woken thread with shorter time slices to the running one. Without them, the woken
/// thread waits until the running one loses the core, for some milliseconds. In earlier kernels, and for threads with
/// another policy or a negative nice value, nothing changes. Threads that the thread creates have the usual slices, and
/// none of its limits by uclamp.
///
/// EEVDF: I. Stoica, H. Abdel-Wahab: Earliest eligible virtual deadline first. Old Dominion University, TR-95-22, 1995.
void runInShortSlices();
}  // namespace gpu_planning_scene::core
