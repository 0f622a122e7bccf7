#pragma once
// How busy the machine is, and what this process has taken of it.
namespace drumlin {

/// Processor time of this process, all its threads, s.
double process_seconds();
/// Load average of the last minute: how busy the machine is with everything; NaN where it is not known.
double load_average();

}  // namespace drumlin
