#include <gtest/gtest.h>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/law/rheology_file.hpp"
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
  const LogLaw law{0.35, 0.013, {1e-4, 1e-5, 2e-6}, 1e-4, 0.1};
  EXPECT_TRUE(faults_of(law).empty());
  LogLaw negative = law, falling = law;
  negative.a = -0.2;
  falling.b = -0.01;
  EXPECT_FALSE(faults_of(negative).empty());
  EXPECT_FALSE(faults_of(falling).empty());
}

/// A law with its words in a file, which are read back to the same text.
void expect_written(const RheologyFit& fit, const std::vector<std::string>& words) {
  const std::string text = rheology_text(fit);
  for (const std::string& word : words) expect_has(text, word);
  EXPECT_EQ(rheology_text(parse_rheology(text, "law.toml")), text);
}

TEST(RheologyFile, WhatWasWrittenIsReadBack) {
  RheologyFit fit;
  fit.mu = LogLaw{0.3612345678901234, 0.0144, {1.1e-5, 2.3e-6, 6.5e-7}, 1.3e-4, 0.087};
  fit.nu = 0.8134;
  fit.fitted_on = {"runs/six", "runs/ten"};
  expect_written(
      fit, {"a = 0.3612345678901234\n", "b = 0.0144\n", "covariance = [1.1e-05, 2.3e-06, 6.5e-07]",
            "I_min = 0.00013\n", "I_max = 0.087\n", "nu = 0.8134\n", "runs = [\"runs/six\", \"runs/ten\"]"});
  for (const char* absent : {"[k]", "nu_ci99", "rms_misfit", "[memory", "[nonlocal"})
    expect_lacks(rheology_text(fit), absent);
  for (const auto& [mu, words] : std::vector<std::pair<FrictionLaw, std::vector<std::string>>>{
           {ConstantLaw{0.31}, {"mu = 0.31\n"}},
           {JopLaw{0.383, 0.643, 0.279}, {"mu_s = 0.383\n", "mu_2 = 0.643\n", "I_0 = 0.279\n"}},
           {JopLaw{0.383, 0.643, 0.279, 0.05, 0.3}, {"I_min = 0.05\n", "I_max = 0.3\n"}},
           {CohesiveLaw{0.5, 0.3, 1.1}, {"c = 0.5\n", "mu_s = 0.3\n", "b = 1.1\n"}},
           {FrictionTable{{1e-4, 1e-2, 0.1}, {0.2, 0.3, 0.33}},
            {"I = [0.0001, 0.01, 0.1]", "mu = [0.2, 0.3, 0.33]"}}}) {
    fit.mu = mu;
    expect_written(fit, words);
  }
  fit.nu_ci99 = 0.001;
  fit.rms_misfit = 0.016;
  fit.reduced = true;
  fit.k = NormalStressRatio{{1e-4, 1e-3, 0.1}, {0.8, 1.2, 1}};
  fit.nonlocal = NonlocalLength{0.5, 0.25, 0.1, {}};
  fit.memory = MemoryLaw{.c = 6.35,
                         .m = 0.9,
                         .chi_deg = 22.9,
                         .c_rho = 300,
                         .I_low = 2e-3,
                         .I_high = 0.02,
                         .mu = {{1e-6, 1e-3}, {0.15, 0.23}}};
  expect_written(fit, {"nu_ci99 = 0.001\n", "rms_misfit = 0.016\n", "reduced = true\n",
                       "I = [0.0001, 0.001, 0.1]\nk = [0.8, 1.2, 1.0]", "amplitude = 0.5\n", "mu_s = 0.25\n",
                       "amplitude_ci99 = 0.1\n", "c = 6.35\n", "m = 0.9\n", "chi_deg = 22.9\n",
                       "c_rho = 300.0\n", "I_low = 0.002\n", "I_high = 0.02\n", "mu = [0.15, 0.23]"});
  for (const char* absent : {"mu_s_ci99", "amount"}) expect_lacks(rheology_text(fit), absent);
  fit.memory->amount = AmountMemory{.swelling = 0.009, .c_nu = 4, .c_psi = 24, .lag = -0.05};
  expect_written(fit, {"swelling = 0.009\n", "c_nu = 4.0\n", "c_psi = 24.0\n", "lag = -0.05\n"});
  expect_lacks(rheology_text(fit), "creep");
  fit.memory->amount->creep = Creep{.slope = 0.016, .ratio = 0.035};
  fit.memory->amount->own_weight = 4;
  expect_written(fit,
                 {"[memory.amount.creep]\n", "slope = 0.016\n", "ratio = 0.035\n", "own_weight = 4.0\n"});
  const TemporaryFolder folder;
  write_rheology(folder / "law.toml", fit);
  EXPECT_EQ(rheology_text(read_rheology(folder / "law.toml")), rheology_text(fit));
}

/// The refusal of the smallest file with another text in the place of one names the file and has these words.
void expect_fault(const std::string& from, const std::string& to, const std::string& words) {
  const std::string text = message_of<InputError>([&] { (void)parse_rheology(with(from, to), "law.toml"); });
  expect_has(text, "law.toml:");
  expect_has(text, words);
}

TEST(RheologyFile, MemoryNamesItsFaults) {
  const auto expect = [&](const std::string& from, const std::string& to, const std::string& words) {
    std::string keys = "c = 6\nm = 1\nchi_deg = 20\nc_rho = 100\nI = [1e-5, 1e-3]\nmu = [0.2, 0.3]\n";
    keys.replace(keys.find(from), from.size(), to);
    expect_fault("[packing]", "[memory]\n" + keys + "[packing]", words);
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
  expect("mu = [0.2, 0.3]\n", table + "swelling = 0.01\nc_nu = 4\nc_psi = 24\nlag = 0\nown_weight = -1\n",
         "memory.amount.own_weight");
}

/// The smallest file with another table [mu].
std::string with_mu(const std::string& keys) {
  return "format = \"drumlin-rheology-1\"\n[mu]\n" + keys + "[packing]\nnu = 0.82\n[fitted_on]\nruns = []\n";
}

TEST(RheologyFile, EveryFormOfMuNamesItsFaults) {
  const auto expect = [&](const std::string& keys, const std::string& place, const std::string& words) {
    const std::string text = message_of<InputError>([&] { (void)parse_rheology(with_mu(keys), "law.toml"); });
    expect_has(text, "law.toml:" + place);
    expect_has(text, words);
  };
  expect("law = \"constant\"\nmu = 0.0\n", "4:", "mu.mu");
  expect("law = \"constant\"\n", "2:", "mu.mu");
  expect("law = \"constant\"\nmu = 0.3\na = 0.3\n", "5:", "mu.a");  // a key of another form
  expect("law = \"jop\"\nmu_s = 0.3\nmu_2 = 0.5\n", "2:", "mu.I_0");
  expect("law = \"jop\"\nmu_s = -0.3\nmu_2 = 0.5\nI_0 = 0.3\n", "4:", "mu.mu_s");
  expect("law = \"jop\"\nmu_s = 0.3\nmu_2 = 0.5\nI_0 = 0\n", "6:", "mu.I_0");
  const std::string jop = "law = \"jop\"\nmu_s = 0.3\nmu_2 = 0.5\nI_0 = 0.3\n";
  expect(jop + "I_min = 0.3\nI_max = 0.1\n", "8:", "is not above I_min");
  expect(jop + "[band]\ndraws = [0.3, 0.2]\n", "8:", "a multiple of 3");
  expect(jop + "[band]\ndraws = [0.3, 20, 0.3]\n", "8:", "out of range");
  expect(jop + "[band]\ndraws = [0.3, -0.1, 0.3]\n", "8:", "mu falls with I");
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
  const std::string cohesive = "law = \"cohesive\"\nc = 0.5\nmu_s = 0.3\nb = 1\n";
  expect("law = \"cohesive\"\nc = -0.1\nmu_s = 0.3\nb = 1\n", "4:", "mu.c");
  // What takes mu for a function of I.
  expect(cohesive + "[k]\nI = [1e-3]\nk = [1]\n", "7:", "k: does not go with mu = 0.3 + 1 I + 0.5/p");
  expect(cohesive + "[nonlocal]\namplitude = 1\nmu_s = 0.3\n", "7:", "nonlocal: does not go");
  expect(cohesive + "[memory]\nc = 6\nm = 1\nchi_deg = 20\nc_rho = 100\nI = [1e-5, 1e-3]\nmu = [0.2, 0.3]\n",
         "7:", "memory: does not go");
  expect(cohesive + "[band]\ndraws = [1]\n", "8:", "band.draws");
  expect("law = \"log10\"\na = 0.35\nb = 0.013\n", "3:", "\"log10\"");
}

TEST(RheologyFile, AFrictionThatFallsWithIIsRefusedWithTheReason) {
  for (const char* keys :
       {"law = \"log\"\na = 0.35\nb = -0.01\ncovariance = [0, 0, 0]\nI_min = 1e-4\nI_max = 1\n",
        "law = \"jop\"\nmu_s = 0.5\nmu_2 = 0.4\nI_0 = 0.3\n",
        "law = \"table\"\nI = [1e-3, 1e-2, 1e-1]\nmu = [0.3, 0.32, 0.31]\n"}) {
    expect_has(message_of<InputError>([&] { (void)parse_rheology(with_mu(keys), "law.toml"); }),
               "falls with I: faster shear would meet less resistance");
  }
  const std::string level = with_mu("law = \"table\"\nI = [1e-3, 1e-2]\nmu = [0.3, 0.3]\n");
  expect_has(message_of<InputError>([&] { (void)parse_rheology(level, "law.toml"); }), "does not change");
}

TEST(RheologyFile, FaultsAreNamedWithTheirPlace) {
  expect_fault("a = 0.35", "a = \"much\"", "law.toml:4:");
  expect_fault("\"log\"", "\"pouliquen\"", "law.toml:3:");
  expect_fault("b = 0.013", "b = -0.1", "law.toml:5:");
  expect_fault("[1e-4, 1e-5, 2e-6]", "[1e-4, 1e-2, 2e-6]", "covariance");
  expect_fault("I_max = 1e-1", "I_max = 1e-5", "I_max");
  expect_fault("nu = 0.82", "nu = 1.2", "law.toml:10:");
  expect_fault("rheology-1", "rheology-9", "format");
  expect_fault("a = 0.35", "a = 0.35\nc = 1", "mu.c");
  expect_fault("[fitted_on]", "[k]\nI = [1e-3, 1e-4]\nk = [1, 1]\n[fitted_on]", "k.I");
  expect_fault("[fitted_on]", "[k]\nI = [1e-4, 1e-3]\nk = [1]\n[fitted_on]", "k.k");
  expect_fault("[fitted_on]", "[k]\nI = []\nk = []\n[fitted_on]", "k.I");
  expect_fault("[fitted_on]", "[k]\nI = [1e-4, 1.1e-4]\nk = [0.8, 1.2]\n[fitted_on]", "several");
}

}  // namespace
}  // namespace drumlin
