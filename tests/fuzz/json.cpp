// Fuzz target: JSON documents as the commands read them. The first line names the file of a measured run or
// of a flow that the rest replaces: run.json, measured.json, flow.json.
#include "coupling/core/files/input_file.hpp"
#include "coupling/core/results/measured_run.hpp"
#include "tests/comparison/run_folders.hpp"
#include "tests/fuzz/one_input.hpp"

using namespace drumlin;

namespace {

struct Folders {
  drumlin::testing::TemporaryFolder folder;
  std::filesystem::path run = drumlin::testing::measured_folder(folder, "run");
  std::filesystem::path flow = drumlin::testing::flow_folder(folder, "flow");
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folders good;
  const std::string text = fuzz::text_of(data, size);
  const auto end = std::min(text.find('\n'), text.size());
  const std::string name = text.substr(0, end), content = text.substr(std::min(end + 1, text.size()));
  const bool of_flow = name == "flow.json";
  const auto file = of_flow                   ? good.flow / "flow.json"
                    : name == "measured.json" ? good.run / "measured" / "measured.json"
                                              : good.run / "run.json";
  const std::string before = input_bytes(file, largest_text_file);
  std::ofstream(file, std::ios::binary) << content;
  fuzz::read_or_refused([&] {
    if (of_flow)
      (void)read_flow_run(good.flow);
    else
      (void)read_measured_run(good.run, Unsteady::accept);
  });
  std::ofstream(file, std::ios::binary) << before;
  return 0;
}
