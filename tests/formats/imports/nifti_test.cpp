// Volumes of NIfTI-1 and NIfTI-2 against values compared one by one.
#include "gzip_text.hpp"
#include "random_volume.hpp"
#include "support/brute_svdag.hpp"
#include "voxdag/stored/attributes/look.hpp"

namespace voxdag {
namespace {

struct Nifti {
  int version = 1;
  bool is_big_endian = false;
  std::vector<int> dim = {};  ///< The number of axes, then their voxels.
  int datatype = 2;
  std::vector<double> pixdim{1, 1, 1, 1};
  double slope = 0, intercept = 0;
  int qform = 0, sform = 0;
  std::vector<double> quaternion{0, 0, 0}, qoffset{0, 0, 0}, srow = std::vector<double>(12);
  int data = 0;  ///< Byte of the data; 0: after the header.
};

/// Writes the fields of a header one by one.
class HeaderWriter {
 public:
  explicit HeaderWriter(const Nifti& nifti)
      : nifti_(nifti), is_first_(nifti.version == 1), text_(is_first_ ? 352 : 544, '\0') {}

  std::string header() {
    put(0, is_first_ ? 348 : 540, 4);
    text_.replace(is_first_ ? 344 : 4, is_first_ ? 4 : 8,
                  is_first_ ? std::string("n+1\0", 4) : std::string("n+2\0\r\n\x1a\n", 8));
    for (std::size_t i = 0; i < nifti_.dim.size(); ++i)
      is_first_ ? put(40 + 2 * i, nifti_.dim[i], 2) : put(16 + 8 * i, nifti_.dim[i], 8);
    put(is_first_ ? 70 : 12, nifti_.datatype, 2);
    put_reals(is_first_ ? 76 : 104, nifti_.pixdim);
    const int data = nifti_.data == 0 ? static_cast<int>(text_.size()) : nifti_.data;
    if (is_first_)
      put_reals(108, {static_cast<double>(data)});
    else
      put(168, data, 8);
    put_reals(is_first_ ? 112 : 176, {nifti_.slope, nifti_.intercept});
    put(is_first_ ? 252 : 344, nifti_.qform, is_first_ ? 2 : 4);
    put(is_first_ ? 254 : 348, nifti_.sform, is_first_ ? 2 : 4);
    put_reals(is_first_ ? 256 : 352, nifti_.quaternion);
    put_reals(is_first_ ? 268 : 376, nifti_.qoffset);
    put_reals(is_first_ ? 280 : 400, nifti_.srow);
    return text_;
  }

 private:
  void put(std::size_t at, std::int64_t value, int bytes) {
    std::string field;
    append(field, static_cast<std::uint64_t>(value), bytes, nifti_.is_big_endian);
    text_.replace(at, field.size(), field);
  }
  void put_reals(std::size_t at, const std::vector<double>& values) {
    for (const double value : values) {
      if (is_first_)
        put(at, std::bit_cast<std::int32_t>(static_cast<float>(value)), 4);
      else
        put(at, std::bit_cast<std::int64_t>(value), 8);
      at += is_first_ ? 4 : 8;
    }
  }

  const Nifti& nifti_;
  bool is_first_;
  std::string text_;
};

std::string header_of(const Nifti& nifti) { return HeaderWriter(nifti).header(); }

class NiftiFiles : public VolumeTest {
 protected:
  template <class T>
  void check_type(int datatype) {
    unsigned seed = 70;
    for (const int version : {1, 2})
      for (const bool is_big_endian : {false, true}) {
        const RandomVolume<T> volume({5, 3, 4}, ++seed);
        Nifti nifti{version, is_big_endian, {3, 5, 3, 4}, datatype};
        const auto text = [&] { return header_of(nifti) + volume.bytes(is_big_endian); };
        write("v.nii", text());
        write("v.nii.gz", gzip(text()));
        for (const char* name : {"v.nii", "v.nii.gz"}) {
          EXPECT_EQ(read(name).voxels, volume.voxels_not_0()) << datatype << version;
          EXPECT_EQ(import(name).dag, brute_svdag(3, volume.voxels_not_0()));
          EXPECT_EQ(read(name, 2.0).voxels, volume.voxels([](T v) { return v >= 2; }));
        }
        nifti.slope = -0.5;
        nifti.intercept = 1;
        write("v.nii", text());
        const auto scaled = [](T v) { return static_cast<double>(v) * -0.5 + 1; };
        EXPECT_EQ(read("v.nii").voxels,
                  volume.voxels([&](T v) { return scaled(v) == scaled(v) && scaled(v) != 0; }));
        EXPECT_EQ(read("v.nii", 0.75).voxels,
                  volume.voxels([&](T v) { return scaled(v) >= 0.75; }));
      }
  }
  std::string error_with(const Nifti& nifti, std::size_t data_bytes = 8) {
    return error_of_bytes("v.nii", header_of(nifti) + std::string(data_bytes, 'x'));
  }
};

TEST_F(NiftiFiles, EveryTypeIsRead) {
  check_type<std::uint8_t>(2);
  check_type<std::int16_t>(4);
  check_type<std::int32_t>(8);
  check_type<float>(16);
  check_type<double>(64);
  check_type<std::int8_t>(256);
  check_type<std::uint16_t>(512);
  check_type<std::uint32_t>(768);
  check_type<std::int64_t>(1024);
  check_type<std::uint64_t>(1280);
}

TEST_F(NiftiFiles, ChannelsKeepTheValuesOfTheVoxels) {
  for (const bool is_scaled : {false, true}) {
    const RandomVolume<std::int16_t> volume({5, 3, 4}, 90);
    Nifti nifti{1, false, {3, 5, 3, 4}, 4};
    if (is_scaled) nifti.slope = 0.25, nifti.intercept = 10;
    const auto value = [&](Vec3i v) {
      return volume.at(v) * (is_scaled ? 0.25 : 1) + 10 * is_scaled;
    };
    write("v.nii.gz", gzip(header_of(nifti) + volume.bytes()));
    for (const double threshold : {-2.0, 10.25}) {
      ImportOptions options;
      options.folder = dir_.path();
      const auto source = open_voxel_source(
          path("v.nii.gz"), {.threshold = threshold, .channels = {{"value", "heat"}}});
      const std::vector<Vec3i> voxels = volume.voxels(
          [&](std::int16_t v) { return v * (is_scaled ? 0.25 : 1) + 10 * is_scaled >= threshold; });
      if (voxels.empty()) continue;
      const ImportResult result = import_voxels(*source, options);
      EXPECT_EQ(result.dag, brute_svdag(3, voxels));
      const ColoredDagView colored{result.dag.view(), result.attributes.view()};
      ASSERT_EQ(colored.attributes.channels.count(), 1u);
      const ChannelView channel = colored.attributes.channels[0];
      EXPECT_EQ(spec_of(channel),
                (ChannelSpec{"heat", is_scaled ? ChannelKind::kF32 : ChannelKind::kI16, 0}));
      for (const Vec3i v : voxels) {
        std::uint64_t number = 0;
        ASSERT_TRUE(find_number(colored, v, 3, number));
        EXPECT_EQ(channel.read(number), value(v));
      }
    }
  }
}

TEST_F(NiftiFiles, ColorsAreRead) {
  write("v.nii", header_of({1, false, {3, 2, 1, 1}, 128}) + std::string("\0\0\0\1\2\3", 6));
  EXPECT_EQ(read("v.nii").voxels, (std::vector<Vec3i>{{1, 0, 0}}));
  EXPECT_EQ(read("v.nii").colors, (std::vector<Rgb8>{{1, 2, 3}}));
  write("v.nii", header_of({1, false, {3, 1, 2, 1}, 2304}) + std::string("\1\2\3\4\5\6\7\0", 8));
  EXPECT_EQ(read("v.nii").voxels, (std::vector<Vec3i>{{0, 0, 0}}));
}

TEST_F(NiftiFiles, OnlyTheFirstVolumeIsRead) {
  for (const bool is_gzip : {false, true}) {
    const std::string text =
        header_of({1, false, {4, 2, 1, 2, 3}, 2}) + std::string("\0\1\0\1", 4) + "more bytes";
    write("v.nii", is_gzip ? gzip(text) : text);
    EXPECT_EQ(read("v.nii").voxels, (std::vector<Vec3i>{{1, 0, 0}, {1, 0, 1}}));
    EXPECT_TRUE(has(open("v.nii")->warnings().at(0), "only the first one is read"));
  }
  write("v.nii", header_of({1, false, {5, 2, 1, 1, 1, 0}, 2}) + std::string("\0\1", 2));
  EXPECT_TRUE(open("v.nii")->warnings().empty());
  write("v.nii", header_of({1, false, {2, 2, 1, 0}, 2}) + std::string("\0\1", 2));
  EXPECT_EQ(read("v.nii").voxels, (std::vector<Vec3i>{{1, 0, 0}}));
}

TEST_F(NiftiFiles, ExtensionsBeforeTheDataAreSkipped) {
  for (const int version : {1, 2}) {
    const int data = version == 1 ? 368 : 560;
    const std::string text = header_of({.version = version, .dim = {3, 1, 1, 2}, .data = data}) +
                             std::string(16, 'e') + std::string("\0\1", 2);
    write("v.nii", text);
    EXPECT_EQ(read("v.nii").voxels, (std::vector<Vec3i>{{0, 0, 1}}));
    write("v.nii.gz", gzip(text));
    EXPECT_EQ(read("v.nii.gz").voxels, (std::vector<Vec3i>{{0, 0, 1}}));
  }
}

TEST_F(NiftiFiles, TheGridIsThatOfTheSformOrQform) {
  for (const int version : {1, 2}) {
    const auto open_with = [&](Nifti nifti) {
      nifti.version = version;
      nifti.dim = {3, 2, 2, 2};
      write("v.nii", header_of(nifti) + "12345678");
      return open("v.nii");
    };
    const auto plain = open_with({.pixdim = {1, 0.5, 0.5, 0.5}, .qoffset = {7, 8, 9}});
    EXPECT_EQ(plain->grid()->voxel_size, 0.5);
    EXPECT_EQ(plain->grid()->origin, (Vec3d{0, 0, 0}));
    const auto boxes = open_with({.pixdim = {1, 2, 0.5, 1}});
    EXPECT_EQ(boxes->grid()->voxel_size, 0.5);
    EXPECT_TRUE(has(boxes->warnings().at(0), "boxes of 2 x 0.5 x 1"));
    const auto moved = open_with({.pixdim = {1, 2, 2, 2}, .qform = 1, .qoffset = {10, -4, 0}});
    EXPECT_EQ(moved->grid()->origin, (Vec3d{9, -5, -1}));
    EXPECT_TRUE(moved->warnings().empty());
    const auto turned = open_with({.qform = 1, .quaternion = {0, 0, 0.3}});
    EXPECT_TRUE(has(turned->warnings().at(0), "turns or shears"));
    const auto mirrored = open_with({.pixdim = {-1, 1, 1, 1}, .qform = 1});
    EXPECT_TRUE(mirrored->warnings().empty());
    const auto matrix = open_with({.qform = 1,
                                   .sform = 2,
                                   .qoffset = {1, 1, 1},
                                   .srow = {4, 0, 0, 2, 0, 4, 0, 3, 0, 0, 4, -6}});
    EXPECT_EQ(matrix->grid()->voxel_size, 4);
    EXPECT_EQ(matrix->grid()->origin, (Vec3d{0, 1, -8}));
    EXPECT_TRUE(matrix->warnings().empty());
    // A matrix of zeros says nothing if there is another placement.
    const auto zero =
        open_with({.pixdim = {1, 2, 2, 2}, .qform = 1, .sform = 1, .qoffset = {10, -4, 0}});
    EXPECT_EQ(zero->grid()->origin, (Vec3d{9, -5, -1}));
    const auto turned_matrix =
        open_with({.sform = 1, .srow = {-1, 0, 0, 2, 0, 1, 0, 3, 0, 0, 1, 0}});
    EXPECT_TRUE(turned_matrix->warnings().empty());
    EXPECT_EQ(turned_matrix->grid()->origin, (Vec3d{0.5, 2.5, -0.5}));
  }
}

TEST_F(NiftiFiles, OtherFilesAreRefused) {
  const Nifti good{1, false, {3, 2, 2, 2}, 2};
  EXPECT_EQ(error_with(good), "no error");
  EXPECT_TRUE(has(error_with(good, 7), "truncated: the volume needs 8 bytes after byte 352"));
  EXPECT_EQ(error_with(good, 9), "no error");
  EXPECT_TRUE(has(open("v.nii")->warnings().at(0), "bytes after the volume are left out: 1"));
  Nifti bad = good;
  bad.dim[0] = 8;
  EXPECT_TRUE(has(error_with(bad), "has 8 axes; 1 to 7 are allowed"));
  bad.dim = {3, 2, -2, 2};
  EXPECT_TRUE(has(error_with(bad), "axis 2 has no voxels"));
  bad = {2, true, {3, 1, 2'000'000, 1}, 2};
  EXPECT_TRUE(has(error_with(bad), "has 2000000 voxels; 1 to 1048576"));
  bad = {2, true, {3, 1'000'000, 1'000'000, 1'000'000}, 64};
  EXPECT_TRUE(has(error_with(bad), "needs 8000000000000000000 bytes"));
  bad = good;
  bad.datatype = 32;
  EXPECT_TRUE(has(error_with(bad), "the data type 32 is not supported"));
  bad = good;
  bad.pixdim[2] = std::nan("");
  EXPECT_TRUE(has(error_with(bad), "the spacing of the voxels must be"));
  bad = good;
  bad.data = 100;
  EXPECT_TRUE(has(error_with(bad), "do not begin at a byte after the header"));
  bad.version = 2;
  EXPECT_TRUE(has(error_with(bad), "the data begin inside the header"));
  bad = good;
  bad.data = 1'000'000;
  EXPECT_TRUE(has(error_with(bad), "truncated: the data begin at byte 1000000"));
  std::string pair = header_of(good);
  pair[345] = 'i';
  EXPECT_TRUE(has(error_of_bytes("v.nii", pair), "data in another file"));
  EXPECT_TRUE(has(error_of_bytes("v.nii", "x" + pair), "is not a NIfTI file"));
}

TEST_F(NiftiFiles, EveryTruncatedOrDamagedFileIsRefusedOrSafe) {
  const RandomVolume<std::uint16_t> volume({3, 2, 2}, 5);
  for (const int version : {1, 2}) {
    const std::string text = header_of({version, true, {3, 3, 2, 2}, 512}) + volume.bytes(true);
    expect_no_prefix_is_read("v.nii", text);
    expect_no_prefix_is_read("v.nii.gz", gzip(text));
    EXPECT_GT(flip_every_bit("v.nii", text), 100);
    EXPECT_GT(flip_every_bit("v.nii.gz", gzip(text)), 300);
  }
}

}  // namespace
}  // namespace voxdag
