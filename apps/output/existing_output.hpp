#pragma once
// What a command does with an output folder that exists already.

namespace drumlin::apps {

enum class ExistingOutput { refuse, resume, overwrite };

}  // namespace drumlin::apps
