#pragma once
// Standard input, output and error of a program: open from its start, and printed to in one checked way.
#include <string_view>

namespace drumlin::apps {

/// Opens each of the descriptors 0, 1 and 2 that is closed on /dev/null, so that no file of ours is opened as
/// one of them. The first thing that a program does. What is printed to an output that was closed is lost,
/// and lost_output() says so; messages to a closed standard error are dropped.
void open_standard_streams();

/// Prints to standard output. What cannot be written does not stop the work: lost_output() says so at its
/// end.
void print_out(std::string_view text);
/// Shows what was printed so far.
void flush_out();
/// Writes what was printed and is still kept back. Why a part of the output is lost (an errno value); 0: it
/// all is written.
int lost_output();

/// Prints a message or progress to standard error; what cannot be written is dropped, for nobody could be
/// told.
void print_error(std::string_view text) noexcept;
/// The same over the line that stands there.
void print_over_line(std::string_view text) noexcept;

}  // namespace drumlin::apps
