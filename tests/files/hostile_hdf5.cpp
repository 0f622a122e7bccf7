// HDF5 files whose names lead elsewhere, or whose datasets say more than they hold, made with HDF5 itself.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <functional>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/hdf5/h5_reader.hpp"
#include "coupling/core/hdf5/h5_writer.hpp"
#include "tests/files/folder.hpp"

namespace drumlin {
namespace {

using testing::TemporaryFolder;

struct Hdf5File {
  explicit Hdf5File(const std::filesystem::path& path)
      : id(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {}
  ~Hdf5File() { H5Fclose(id); }
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;
  hid_t id;
};

/// A dataset "x" of so many numbers; `ask` says how it is stored, `numbers` are written unless there are
/// none.
void add_x(hid_t file, hsize_t count, const std::function<void(hid_t)>& ask,
           const std::vector<double>& numbers) {
  const hid_t space = H5Screate_simple(1, &count, nullptr), creation = H5Pcreate(H5P_DATASET_CREATE);
  ask(creation);
  const hid_t set = H5Dcreate2(file, "x", H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  ASSERT_GE(set, 0);
  if (!numbers.empty()) {
    ASSERT_GE(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), 0);
  }
  H5Dclose(set), H5Pclose(creation), H5Sclose(space);
}

void as_it_is(hid_t) {}

std::string refusal(const std::filesystem::path& file, const std::string& name = "x") {
  return message_of<InputError>([&] { (void)H5Reader(file, false).doubles(name); });
}

TEST(HostileHdf5, LinksThatLeadElsewhereAreNotFollowed) {
  const TemporaryFolder folder;
  {
    const Hdf5File secret(folder / "secret.h5"), file(folder / "f.h5");
    add_x(secret.id, 2, as_it_is, {1, 2});
    add_x(file.id, 2, as_it_is, {1, 2});
    H5Lcreate_external((folder / "secret.h5").c_str(), "x", file.id, "outside", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external((folder / "secret.h5").c_str(), "/", file.id, "group", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/x", file.id, "soft", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/round", file.id, "round", H5P_DEFAULT, H5P_DEFAULT);
  }
  for (const char* name : {"outside", "group/x", "soft", "round"})
    expect_has(refusal(folder / "f.h5", name), "soft or external link");
  EXPECT_EQ(H5Reader(folder / "f.h5", false).doubles("x"), (std::vector<double>{1, 2}));
}

TEST(HostileHdf5, DataInAnotherFileAreNotRead) {
  const TemporaryFolder folder;
  folder.with("secret", std::string(16, 'x'));
  {
    const Hdf5File file(folder / "f.h5");
    add_x(file.id, 2, [&](hid_t creation) { H5Pset_external(creation, (folder / "secret").c_str(), 0, 16); },
          {});
  }
  expect_has(refusal(folder / "f.h5"), "another file");
}

// 2 GiB would be allocated for each of them; refused, they take nothing.
TEST(HostileHdf5, LengthsThatTheFileCannotHoldAreRefusedBeforeTheyAreAllocated) {
  const TemporaryFolder folder;
  const hsize_t many = hsize_t{1} << 28, chunk = 1 << 20, one = 1;
  const auto refused = [&](hsize_t count, const std::function<void(hid_t)>& ask,
                           const std::vector<double>& numbers) {
    {
      const Hdf5File file(folder / "f.h5");
      add_x(file.id, count, ask, numbers);
    }
    return refusal(folder / "f.h5");
  };
  expect_has(refused(many, as_it_is, {}), "more numbers than the file holds");
  expect_has(refused(many, [&](hid_t c) { H5Pset_chunk(c, 1, &chunk), H5Pset_deflate(c, 1); }, {}),
             "more numbers than the file holds");
  expect_has(refused(2 * many, as_it_is, {}), "impossible size");
  expect_has(refused(1,
                     [&](hid_t c) {
                       H5Pset_chunk(c, 1, &one), H5Pset_filter(c, 32000, H5Z_FLAG_OPTIONAL, 0, nullptr);
                     },
                     {}),
             "filter");
}

TEST(HostileHdf5, PackedDataAreRead) {
  const TemporaryFolder folder;
  const hsize_t chunk = 100;
  {
    const Hdf5File file(folder / "f.h5");
    add_x(
        file.id, 1000, [&](hid_t c) { H5Pset_chunk(c, 1, &chunk), H5Pset_shuffle(c), H5Pset_deflate(c, 9); },
        std::vector<double>(1000, 0.5));
  }
  EXPECT_EQ(H5Reader(folder / "f.h5", false).doubles("x"), std::vector<double>(1000, 0.5));
}

// What version 1 wrote: bytes for texts, arrays of one for numbers.
TEST(OlderHdf5, TextsAndNumbersAreReadAsThoseOfToday) {
  const TemporaryFolder folder;
  const std::string words = "d = 2 \xC2\xB5m\n";
  H5Writer out;
  out.add("old/text", std::vector<std::int32_t>{'a', 'b'});
  out.add("old/number", std::vector<double>{2.5});
  out.add("old/integer", std::vector<std::int64_t>{7});
  out.add_text("new/text", words);
  out.add_number("new/number", 2.5, {"d", "a length"});
  out.add_number("new/integer", std::int64_t{7});
  out.add_text("nothing", "");
  out.save(folder / "f.h5");
  const H5Reader in(folder / "f.h5");
  for (const std::string of : {"old", "new"}) {
    EXPECT_EQ(in.number(of + "/number"), 2.5);
    EXPECT_EQ(in.integer(of + "/integer"), 7);
  }
  EXPECT_EQ(in.text("old/text"), "ab");
  EXPECT_EQ(in.text("new/text"), words);
  EXPECT_EQ(in.text("nothing"), "");
  EXPECT_TRUE(in.shape("new/text").empty());
  EXPECT_TRUE(in.shape("new/number").empty());
  expect_has(refusal(folder / "f.h5", "new/text"), "unexpected type");
  in.require_readable();
}

}  // namespace
}  // namespace drumlin
