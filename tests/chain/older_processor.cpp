// Makes a program, into which it is preloaded, take the vector kernels of an older processor: those of the
// target that OLDER_PROCESSOR names as Highway does (AVX2, SSE4, SCALAR ...). A line with its name is added
// to the file that OLDER_PROCESSOR_TELLS names, when the program asks for it and the processor has it.
#include <dlfcn.h>
#include <hwy/targets.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace hwy {

int64_t SupportedTargets() {
  using Call = int64_t();
  static auto* const of_processor = reinterpret_cast<Call*>(dlsym(RTLD_NEXT, "_ZN3hwy16SupportedTargetsEv"));
  const char* const name = std::getenv("OLDER_PROCESSOR");
  const char* const file = std::getenv("OLDER_PROCESSOR_TELLS");
  const int64_t targets = of_processor() | HWY_SCALAR;
  if (!name || !file) return targets;
  for (int64_t left = targets; left != 0; left &= left - 1) {
    const int64_t target = left & -left;
    if (std::string_view(TargetName(target)) != name) continue;
    if (std::FILE* const record = std::fopen(file, "a")) {
      std::fprintf(record, "%s\n", name);
      std::fclose(record);
    }
    return target;
  }
  return targets;
}

}  // namespace hwy
