// Feeds a target without libFuzzer: each file of the folders, then so many mutations of them, drawn from a
// fixed seed.
//   fuzz_TARGET MUTATIONS FOLDER...
// The same inputs come everywhere. Input K, named by a program that ends in between, is written by
//   fuzz_TARGET --write K FILE MUTATIONS FOLDER...
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

volatile std::sig_atomic_t input = 0;

/// Says which input it was, and ends as the signal would have.
void say_which(int signal) {
  std::array<char, 64> text{"ended by input "};
  char* const end = std::to_chars(text.data() + std::strlen(text.data()), text.data() + 60, int{input}).ptr;
  *end = '\n';
  if (::write(STDERR_FILENO, text.data(), static_cast<std::size_t>(end + 1 - text.data())) < 0) std::_Exit(1);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

std::vector<std::string> files_in(const std::vector<std::string>& folders) {
  std::vector<std::filesystem::path> files;
  for (const std::string& folder : folders)
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const auto& name : files) {
    std::ifstream stream(name, std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return texts;
}

/// Draws from a generator whose numbers the standard fixes; its distributions differ from library to library.
struct Draw {
  std::mt19937_64 bits{20240607};
  std::size_t below(std::size_t end) { return end == 0 ? 0 : bits() % end; }
};

const std::vector<std::string> pieces{"0",
                                      "-1",
                                      "1e308",
                                      "-1e-320",
                                      "nan",
                                      "inf",
                                      "2.7",
                                      "2147483648",
                                      "9223372036854775807",
                                      "null",
                                      "true",
                                      "{",
                                      "}",
                                      "[",
                                      "]",
                                      "\"",
                                      "'",
                                      "\\",
                                      ".",
                                      ",",
                                      "=",
                                      ":",
                                      "#",
                                      "\n",
                                      "\t",
                                      " ",
                                      "*",
                                      "\xEF\xBB\xBF",
                                      "\xff",
                                      std::string(1, '\0'),
                                      "[[",
                                      "\"\"\"",
                                      "$",
                                      "/",
                                      "../"};

/// One change: a stretch cut out, doubled or taken from another text, a piece put in, a number or a byte
/// replaced.
void change(std::string& text, const std::vector<std::string>& texts, Draw& draw) {
  const std::size_t at = draw.below(text.size() + 1), length = draw.below(draw.below(8) == 0 ? 400 : 12);
  const std::string& other = texts[draw.below(texts.size())];
  const std::string& piece = pieces[draw.below(pieces.size())];
  const std::size_t digit = std::min(text.find_first_of("0123456789", at), text.size());
  switch (draw.below(6)) {
    case 0:
      text.erase(at, length);
      break;
    case 1:
      text.insert(at, text.substr(at, length));
      break;
    case 2:
      text.insert(at, other.substr(draw.below(other.size() + 1), length));
      break;
    case 3:
      text.insert(at, piece);
      break;
    case 4:
      text.replace(digit, text.find_first_not_of("0123456789.e+-", digit) - digit, piece);
      break;
    default:
      if (at < text.size()) text[at] = static_cast<char>(draw.bits());
  }
}

void feed(const std::string& text) {
  // On the heap, of this very length, so that a sanitizer sees a step past the end.
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  int wanted = -1;
  std::string file;
  if (words.size() > 3 && words[0] == "--write") {
    wanted = std::atoi(words[1].c_str()), file = words[2];
    words.erase(words.begin(), words.begin() + 3);
  }
  if (words.size() < 2) return 2;
  const int mutations = std::atoi(words[0].c_str());
  const std::vector<std::string> texts = files_in({words.begin() + 1, words.end()});
  if (texts.empty()) return 2;
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGILL, SIGBUS}) std::signal(signal, say_which);
  Draw draw;
  const int all = static_cast<int>(texts.size()) + mutations;
  for (int k = 0; k < all; ++k) {
    std::string text = static_cast<std::size_t>(k) < texts.size() ? texts[static_cast<std::size_t>(k)]
                                                                  : texts[draw.below(texts.size())];
    if (static_cast<std::size_t>(k) >= texts.size())
      for (std::size_t changes = 1 + draw.below(4); changes > 0; --changes) change(text, texts, draw);
    input = k;
    if (k == wanted) std::ofstream(file, std::ios::binary) << text;
    if (wanted < 0) feed(text);
  }
  std::printf("%d inputs read or refused\n", all);
  return 0;
}
