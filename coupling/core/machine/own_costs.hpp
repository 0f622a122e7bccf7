#pragma once
// What this process has cost so far, and how busy the machine is.

namespace drumlin {

double own_cpu_seconds();     ///< of all its threads, in user and system mode
double own_peak_memory_mb();  ///< the most that was resident at a time, 2^20 bytes
double load_average();        ///< of the last minute, by everything on the machine; NaN: not known

}  // namespace drumlin
