#include <gtest/gtest.h>

#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/rheology_fit.hpp"
#include "tests/exchange_files/folder.hpp"

namespace drumlin {
namespace {

using testing::message_of;
using testing::TemporaryFolder;

constexpr const char* smallest = R"(format = "drumlin-rheology-1"
[mu]
law = "log"
a = 0.35
b = 0.013
covariance = [1e-4, 1e-5, 2e-6]
I_min = 1e-4
I_max = 1e-1
[packing]
nu = 0.82
[fitted_on]
runs = ["somewhere"]
)";

std::string with(const std::string& from, const std::string& to) {
  std::string text = smallest;
  text.replace(text.find(from), from.size(), to);
  return text;
}

TEST(RheologyFile, WhatWasWrittenIsReadBack) {
  const TemporaryFolder folder;
  RheologyFit fit;
  fit.mu = {0.3612345678901234, 0.0144, {1.1e-5, 2.3e-6, 6.5e-7}, 1.3e-4, 0.087};
  fit.k = NormalStressRatio{{1e-4, 1e-3, 0.1}, {0.8, 1.2, 1}};
  fit.nu = 0.8134;
  fit.nu_ci99 = 0.001;
  fit.rms_misfit = 0.016;
  fit.fitted_on = {"runs/six", "runs/ten"};
  fit.reduced = true;
  write_rheology(folder / "rheology.toml", fit);
  const RheologyFit read = read_rheology(folder / "rheology.toml");
  EXPECT_EQ(read.mu.a, fit.mu.a);
  EXPECT_EQ(read.mu.b, fit.mu.b);
  EXPECT_EQ(read.mu.covariance, fit.mu.covariance);
  EXPECT_EQ(read.mu.I_min, fit.mu.I_min);
  EXPECT_EQ(read.mu.I_max, fit.mu.I_max);
  ASSERT_TRUE(read.k);
  EXPECT_EQ(read.k->I, fit.k->I);
  EXPECT_EQ(read.k->k, fit.k->k);
  EXPECT_EQ(read.nu, fit.nu);
  EXPECT_EQ(read.nu_ci99, fit.nu_ci99);
  EXPECT_EQ(read.rms_misfit, fit.rms_misfit);
  EXPECT_EQ(read.fitted_on, fit.fitted_on);
  EXPECT_TRUE(read.reduced);
}

TEST(RheologyFile, WhatIsOptionalMayBeAbsent) {
  const TemporaryFolder folder;
  const RheologyFit fit = read_rheology(folder.with("law.toml", smallest));
  EXPECT_FALSE(fit.k);
  EXPECT_FALSE(fit.nu_ci99);
  EXPECT_FALSE(fit.rms_misfit);
  EXPECT_FALSE(fit.reduced);
}

TEST(RheologyFile, FaultsAreNamedWithTheirPlace) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& text) {
    const auto file = folder.with("law.toml", text);
    return message_of<InputError>([&] { read_rheology(file); });
  };
  EXPECT_NE(message(with("a = 0.35", "a = \"much\"")).find("law.toml:4:"), std::string::npos);
  EXPECT_NE(message(with("\"log\"", "\"pouliquen\"")).find("law.toml:3:"), std::string::npos);
  EXPECT_NE(message(with("b = 0.013", "b = -0.1")).find("law.toml:5:"), std::string::npos);
  EXPECT_NE(message(with("[1e-4, 1e-5, 2e-6]", "[1e-4, 1e-2, 2e-6]")).find("covariance"), std::string::npos);
  EXPECT_NE(message(with("I_max = 1e-1", "I_max = 1e-5")).find("I_max"), std::string::npos);
  EXPECT_NE(message(with("nu = 0.82", "nu = 1.2")).find("law.toml:10:"), std::string::npos);
  EXPECT_NE(message(with("rheology-1", "rheology-9")).find("format"), std::string::npos);
  EXPECT_NE(message(with("a = 0.35", "a = 0.35\nc = 1")).find("mu.c"), std::string::npos);
  EXPECT_NE(message(std::string(smallest) + "[k]\nI = [1e-3, 1e-4]\nk = [1, 1]\n").find("k.I"),
            std::string::npos);
  EXPECT_NE(message(std::string(smallest) + "[k]\nI = [1e-4, 1e-3]\nk = [1]\n").find("k.k"),
            std::string::npos);
}

}  // namespace
}  // namespace drumlin
