#include <gtest/gtest.h>

#include "coupling/common/errors.hpp"
#include "coupling/law/rheology_file.hpp"
#include "tests/files/folder.hpp"

namespace drumlin {
namespace {

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

TEST(RheologyFile, ALawGrowsAndIsPositiveAtTheLargestI) {
  const LogFriction law{0.35, 0.013, {1e-4, 1e-5, 2e-6}, 1e-4, 0.1};
  EXPECT_TRUE(is_law(law));
  LogFriction negative = law, falling = law;
  negative.a = -0.2;
  falling.b = -0.01;
  EXPECT_FALSE(is_law(negative));
  EXPECT_FALSE(is_law(falling));
}

TEST(RheologyFile, WhatWasWrittenIsReadBack) {
  const TemporaryFolder folder;
  RheologyFit fit;
  fit.mu = LogFriction{0.3612345678901234, 0.0144, {1.1e-5, 2.3e-6, 6.5e-7}, 1.3e-4, 0.087};
  fit.k = NormalStressRatio{{1e-4, 1e-3, 0.1}, {0.8, 1.2, 1}};
  fit.nu = 0.8134;
  fit.nu_ci99 = 0.001;
  fit.rms_misfit = 0.016;
  fit.fitted_on = {"runs/six", "runs/ten"};
  fit.reduced = true;
  write_rheology(folder / "rheology.toml", fit);
  const RheologyFit read = read_rheology(folder / "rheology.toml");
  const auto &mu = std::get<LogFriction>(read.mu), &written = std::get<LogFriction>(fit.mu);
  EXPECT_EQ(mu.a, written.a);
  EXPECT_EQ(mu.b, written.b);
  EXPECT_EQ(mu.covariance, written.covariance);
  EXPECT_EQ(mu.I_min, written.I_min);
  EXPECT_EQ(mu.I_max, written.I_max);
  ASSERT_TRUE(read.k);
  EXPECT_EQ(read.k->I, fit.k->I);
  EXPECT_EQ(read.k->k, fit.k->k);
  EXPECT_EQ(read.nu, fit.nu);
  EXPECT_EQ(read.nu_ci99, fit.nu_ci99);
  EXPECT_EQ(read.rms_misfit, fit.rms_misfit);
  EXPECT_EQ(read.fitted_on, fit.fitted_on);
  EXPECT_TRUE(read.reduced);
}

TEST(RheologyFile, MemoryIsWrittenAndReadBackAndAbsentOtherwise) {
  const TemporaryFolder folder;
  RheologyFit fit;
  fit.mu = ConstantFriction{0.3};
  fit.nu = 0.8;
  write_rheology(folder / "without.toml", fit);
  EXPECT_FALSE(read_rheology(folder / "without.toml").memory);
  fit.memory = MemoryLaw{.c = 6.35,
                         .m = 0.9,
                         .chi_deg = 22.9,
                         .c_rho = 300,
                         .I_low = 2e-3,
                         .I_high = 0.02,
                         .mu = {{1e-6, 1e-3}, {0.15, 0.23}}};
  write_rheology(folder / "with.toml", fit);
  const auto memory = read_rheology(folder / "with.toml").memory;
  ASSERT_TRUE(memory);
  EXPECT_EQ(memory->c, 6.35);
  EXPECT_EQ(memory->m, 0.9);
  EXPECT_EQ(memory->chi_deg, 22.9);
  EXPECT_EQ(memory->c_rho, 300);
  EXPECT_EQ(memory->I_low, 2e-3);
  EXPECT_EQ(memory->I_high, 0.02);
  EXPECT_EQ(memory->mu.I, fit.memory->mu.I);
  EXPECT_EQ(memory->mu.mu, fit.memory->mu.mu);
  EXPECT_FALSE(memory->amount);
  fit.memory->amount = AmountMemory{.swelling = 0.009, .c_nu = 4, .c_psi = 24, .lag = -0.05};
  write_rheology(folder / "amount.toml", fit);
  const auto amount = read_rheology(folder / "amount.toml").memory.value().amount;
  ASSERT_TRUE(amount);
  EXPECT_EQ(amount->swelling, 0.009);
  EXPECT_EQ(amount->c_nu, 4);
  EXPECT_EQ(amount->c_psi, 24);
  EXPECT_EQ(amount->lag, -0.05);
}

TEST(RheologyFile, MemoryNamesItsFaults) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& from, const std::string& to, const std::string& words) {
    std::string keys = "c = 6\nm = 1\nchi_deg = 20\nc_rho = 100\nI = [1e-5, 1e-3]\nmu = [0.2, 0.3]\n";
    keys.replace(keys.find(from), from.size(), to);
    const auto file = folder.with("law.toml", with("[packing]", "[memory]\n" + keys + "[packing]"));
    const std::string text = message_of<InputError>([&] { read_rheology(file); });
    expect_has(text, "law.toml:");
    expect_has(text, words);
  };
  expect("c = 6\n", "", "memory.c");
  expect("c = 6\n", "c = 0\n", "memory.c");
  expect("m = 1\n", "m = 1.18\n", "0 to 1");
  expect("chi_deg = 20", "chi_deg = 91", "memory.chi_deg");
  expect("chi_deg = 20", "chi_deg = 20\nI_low = 0.1", "memory.I_high");
  expect("mu = [0.2, 0.3]", "mu = [0.3, 0.2]", "memory.mu");
  expect("mu = [0.2, 0.3]", "mu = [0.3]", "one mu for each I");
  expect("I = [1e-5, 1e-3]", "I = [1e-3, 1e-3]", "ascending");
  const std::string table = "mu = [0.2, 0.3]\n[memory.amount]\n";
  expect("mu = [0.2, 0.3]\n", table + "c_nu = 4\nc_psi = 24\nlag = 0\n", "memory.amount.swelling");
  expect("mu = [0.2, 0.3]\n", table + "swelling = 0\nc_nu = 4\nc_psi = 24\nlag = 0\n",
         "memory.amount.swelling");
  expect("mu = [0.2, 0.3]\n", table + "swelling = 0.01\nc_nu = 4\nc_psi = 24\nlag = 2\n",
         "memory.amount.lag");
}

/// The smallest file with another table [mu].
std::string with_mu(const std::string& keys) {
  return "format = \"drumlin-rheology-1\"\n[mu]\n" + keys + "[packing]\nnu = 0.82\n[fitted_on]\nruns = []\n";
}

TEST(RheologyFile, EveryFormOfMuIsWrittenAndReadBack) {
  const TemporaryFolder folder;
  const auto again = [&](const MeasuredFriction& mu) {
    RheologyFit fit;
    fit.mu = mu;
    fit.nu = 0.8;
    write_rheology(folder / "law.toml", fit);
    return read_rheology(folder / "law.toml").mu;
  };
  EXPECT_EQ(std::get<ConstantFriction>(again(ConstantFriction{0.31})).mu, 0.31);
  const auto jop = std::get<JopFriction>(again(JopFriction{0.383, 0.643, 0.279}));
  EXPECT_EQ(jop.mu_s, 0.383);
  EXPECT_EQ(jop.mu_2, 0.643);
  EXPECT_EQ(jop.I_0, 0.279);
  const auto table = std::get<FrictionTable>(again(FrictionTable{{1e-4, 1e-2, 0.1}, {0.2, 0.3, 0.33}}));
  EXPECT_EQ(table.I, (std::vector{1e-4, 1e-2, 0.1}));
  EXPECT_EQ(table.mu, (std::vector{0.2, 0.3, 0.33}));
}

TEST(RheologyFile, EveryFormOfMuNamesItsFaults) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& keys) {
    const auto file = folder.with("law.toml", with_mu(keys));
    return message_of<InputError>([&] { read_rheology(file); });
  };
  const auto expect = [&](const std::string& keys, const std::string& place, const std::string& words) {
    const std::string text = message(keys);
    expect_has(text, "law.toml:" + place);
    expect_has(text, words);
  };
  expect("law = \"constant\"\nmu = 0.0\n", "4:", "mu.mu");
  expect("law = \"constant\"\n", "2:", "mu.mu");
  expect("law = \"constant\"\nmu = 0.3\na = 0.3\n", "5:", "mu.a");  // a key of another form
  expect("law = \"jop\"\nmu_s = 0.3\nmu_2 = 0.5\n", "2:", "mu.I_0");
  expect("law = \"jop\"\nmu_s = -0.3\nmu_2 = 0.5\nI_0 = 0.3\n", "4:", "mu.mu_s");
  expect("law = \"jop\"\nmu_s = 0.3\nmu_2 = 0.5\nI_0 = 0\n", "6:", "mu.I_0");
  expect("law = \"table\"\nI = [1e-3]\nmu = [0.3]\n", "4:", "two at least");
  expect("law = \"table\"\nI = [1e-3, 1e-2]\nmu = [0.3]\n", "5:", "one mu for each I");
  expect("law = \"table\"\nI = [1e-2, 1e-3]\nmu = [0.2, 0.3]\n", "4:", "ascending");
  expect("law = \"table\"\nI = [0.0, 1e-3]\nmu = [0.2, 0.3]\n", "4:", "mu.I");
  expect("law = \"table\"\nI = [1e-3, 1e-2]\nmu = [-0.2, 0.3]\n", "5:", "mu.mu");
  // The natural logarithm is the only one: with log10 the same numbers are another law, ill-posed from I =
  // 1e-5.
  // Out of the range of any material, one by one or together.
  const std::string rest = "covariance = [0, 0, 0]\nI_min = 1e-4\nI_max = 0.1\n";
  expect("law = \"log\"\na = 1e308\nb = 0.01\n" + rest, "4:", "-10 to 10");
  expect("law = \"log\"\na = nan\nb = 0.01\n" + rest, "4:", "mu.a");
  expect("law = \"log\"\na = -5\nb = 0.01\n" + rest, "4:", "mu of 0.001 to 10");
  expect("law = \"log\"\na = 9\nb = -9\n" + rest, "4:", "mu of 0.001 to 10");
  expect("law = \"log-linear\"\na = 1\nb = 0\nc = 900\nI_min = 1e-4\nI_max = 0.1\n", "4:", "gives mu = 91");
  expect("law = \"log\"\na = 0.3\nb = inf\n" + rest, "5:", "mu.b");
  expect("law = \"log\"\na = 0.3\nb = 0.01\ncovariance = [0, 0, 0]\nI_min = 1e-300\nI_max = 0.1\n",
         "7:", "1e-12 to 1000");
  expect("law = \"constant\"\nmu = 1e-9\n", "4:", "0.001 to 10");
  expect("law = \"jop\"\nmu_s = 0.3\nmu_2 = 1e9\nI_0 = 0.3\n", "5:", "mu.mu_2");
  expect("law = \"table\"\nI = [1e-3, 1e-2]\nmu = [0.2, 300]\n", "5:", "mu.mu.1");
  expect("law = \"log10\"\na = 0.35\nb = 0.013\n", "3:", "\"log10\"");
}

TEST(RheologyFile, AFrictionThatFallsWithIIsRefusedWithTheReason) {
  const TemporaryFolder folder;
  for (const char* keys :
       {"law = \"log\"\na = 0.35\nb = -0.01\ncovariance = [0, 0, 0]\nI_min = 1e-4\nI_max = 1\n",
        "law = \"jop\"\nmu_s = 0.5\nmu_2 = 0.4\nI_0 = 0.3\n",
        "law = \"table\"\nI = [1e-3, 1e-2, 1e-1]\nmu = [0.3, 0.32, 0.31]\n"}) {
    const auto file = folder.with("law.toml", with_mu(keys));
    const std::string text = message_of<InputError>([&] { read_rheology(file); });
    expect_has(text, "falls with I: faster shear would meet less resistance");
  }
  const auto level = folder.with("law.toml", with_mu("law = \"table\"\nI = [1e-3, 1e-2]\nmu = [0.3, 0.3]\n"));
  expect_has(message_of<InputError>([&] { read_rheology(level); }), "stands still");
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
  expect_has(message(with("a = 0.35", "a = \"much\"")), "law.toml:4:");
  expect_has(message(with("\"log\"", "\"pouliquen\"")), "law.toml:3:");
  expect_has(message(with("b = 0.013", "b = -0.1")), "law.toml:5:");
  expect_has(message(with("[1e-4, 1e-5, 2e-6]", "[1e-4, 1e-2, 2e-6]")), "covariance");
  expect_has(message(with("I_max = 1e-1", "I_max = 1e-5")), "I_max");
  expect_has(message(with("nu = 0.82", "nu = 1.2")), "law.toml:10:");
  expect_has(message(with("rheology-1", "rheology-9")), "format");
  expect_has(message(with("a = 0.35", "a = 0.35\nc = 1")), "mu.c");
  expect_has(message(std::string(smallest) + "[k]\nI = [1e-3, 1e-4]\nk = [1, 1]\n"), "k.I");
  expect_has(message(std::string(smallest) + "[k]\nI = [1e-4, 1e-3]\nk = [1]\n"), "k.k");
  expect_has(message(std::string(smallest) + "[k]\nI = []\nk = []\n"), "k.I");
  expect_has(message(std::string(smallest) + "[k]\nI = [1e-4, 1.1e-4]\nk = [0.8, 1.2]\n"), "several");
}

}  // namespace
}  // namespace drumlin
