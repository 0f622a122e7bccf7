#pragma once
// SIGINT and SIGTERM as a flag, so that a run can leave a checkpoint before it ends.
namespace drumlin::apps {

/// From now on the signals only set the flag, and a limit on the size of files makes writes fail.
void catch_interruptions();
/// The signal that came, 0 if none.
int interruption();

}  // namespace drumlin::apps
