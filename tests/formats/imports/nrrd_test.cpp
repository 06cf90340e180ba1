// Volumes of NRRD in every encoding, against values compared one by one.
#include "gzip_text.hpp"
#include "random_volume.hpp"
#include "support/brute_svdag.hpp"

namespace voxdag {
namespace {

std::string sizes_of(Vec3i size) {
  return "sizes: " + std::to_string(size.x) + " " + std::to_string(size.y) + " " +
         std::to_string(size.z) + "\n";
}

class Nrrd : public VolumeTest {
 protected:
  template <class T>
  void check_type(const std::vector<std::string>& names) {
    unsigned seed = 40;
    for (const std::string& name : names)
      for (const bool is_big_endian : {false, true})
        for (const bool is_gzip : {false, true}) {
          const RandomVolume<T> volume({5, 3, 4}, ++seed);
          const std::string bytes = volume.bytes(is_big_endian);
          write("v.nrrd", "NRRD0004\n# made by a test\ntype: " + name + "\ndimension: 3\n" +
                              sizes_of(volume.size) + "encoding: " + (is_gzip ? "gzip" : "raw") +
                              "\nkey:=value\nendian: " + (is_big_endian ? "big" : "little") +
                              "\n\n" + (is_gzip ? gzip(bytes) : bytes));
          EXPECT_EQ(read("v.nrrd").voxels, volume.voxels_not_0()) << name;
          EXPECT_EQ(import("v.nrrd").dag, brute_svdag(3, volume.voxels_not_0()));
          EXPECT_EQ(read("v.nrrd", 2.0).voxels, volume.voxels([](T v) { return v >= 2; })) << name;
        }
  }
  /// Returns the error of a file of 8 bytes of data with this header.
  std::string header_error(const std::string& fields) {
    return error_of_bytes("v.nrrd", "NRRD0005\n" + fields + "\n\n12345678");
  }
};

TEST_F(Nrrd, EveryTypeIsRead) {
  check_type<std::int8_t>({"int8", "signed char"});
  check_type<std::uint8_t>({"uchar", "unsigned char", "uint8_t"});
  check_type<std::int16_t>({"short", "signed short int"});
  check_type<std::uint16_t>({"ushort", "unsigned short"});
  check_type<std::int32_t>({"int", "int32"});
  check_type<std::uint32_t>({"uint", "unsigned int"});
  check_type<std::int64_t>({"long long int", "int64"});
  check_type<std::uint64_t>({"ulonglong", "unsigned long long"});
  check_type<float>({"float"});
  check_type<double>({"double", "Double"});
}

TEST_F(Nrrd, NumbersAsTextAreRead) {
  const std::string header = "NRRD0001\ndimension: 3\nsizes: 2 1 3\nencoding: ";
  write("v.nrrd", header + "ascii\ntype: float\n\n0.5 0\n1e2,-3\tnan\r\n +4\n");
  EXPECT_EQ(read("v.nrrd").voxels,
            (std::vector<Vec3i>{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 2}}));
  EXPECT_EQ(read("v.nrrd", 0.75).voxels, (std::vector<Vec3i>{{0, 0, 1}, {1, 0, 2}}));
  write("v.nrrd", header + "text\ntype: uint8\n\n0 7 0 0 255 0");
  EXPECT_EQ(read("v.nrrd").voxels, (std::vector<Vec3i>{{1, 0, 0}, {0, 0, 2}}));
  write("v.nrrd", header + "hex\ntype: short\nendian: big\n\n00fF 0000\n1000 0000FFFF 00 01 \n");
  EXPECT_EQ(read("v.nrrd", 1.0).voxels, (std::vector<Vec3i>{{0, 0, 0}, {0, 0, 1}, {1, 0, 2}}));
  const auto error = [&](const std::string& rest) {
    return error_of_bytes("v.nrrd", header + rest);
  };
  EXPECT_TRUE(has(error("ascii\ntype: uint8\n\n0 7 0 0 255"), "has more values than the file"));
  EXPECT_TRUE(
      has(error("ascii\ntype: uint8\n\n0 7 0 0 256 0"), "is not a number of the volume's type"));
  EXPECT_TRUE(
      has(error("ascii\ntype: uint8\n\n0 7 0 0 5 1.5"), "is not a number of the volume's type"));
  EXPECT_TRUE(has(error("ascii\ntype: uint8\n\n0 7 0 0 5 1 1"), "has more values than the volume"));
  EXPECT_TRUE(has(error("hex\ntype: uint8\n\n00 00 00 00 00 0"), "has more values than the file"));
  EXPECT_TRUE(has(error("hex\ntype: uint8\n\n00 00 00 0g 00 00"), "two hexadecimal digits"));
  EXPECT_TRUE(has(error("hex\ntype: uint8\n\n00 00 00 0 0 00 00"), "two hexadecimal digits"));
}

TEST_F(Nrrd, DataInAFileBesideTheHeader) {
  const RandomVolume<std::uint8_t> volume({4, 3, 2}, 8);
  const std::string header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 3 2\n";
  const auto check = [&](const std::string& fields, const std::string& data) {
    write("d.raw", data);
    write("v.nhdr", header + fields);
    EXPECT_EQ(read("v.nhdr").voxels, volume.voxels_not_0()) << fields;
  };
  const std::string bytes = volume.bytes();
  check("encoding: raw\ndata file: d.raw\n", bytes);
  check("encoding: raw\ndatafile: ./d.raw", bytes);
  check("encoding: raw\nbyte skip: 3\ndata file: d.raw\n\n", "xyz" + bytes + "more");
  check("encoding: raw\nbyte skip: -1\nline skip: 1\ndata file: d.raw\n", "a\nxyz" + bytes);
  check("encoding: raw\nline skip: 2\nbyte skip: 1\ndata file: d.raw\n", "a\n\n+" + bytes);
  check("encoding: gz\nline skip: 1\nbyteskip: 5\ndata file: d.raw\n",
        "a\n" + gzip("12345" + bytes));
  check("encoding: gzip\ndata file: d.raw\n",
        gzip(bytes.substr(0, 7)) + gzip("") + gzip(bytes.substr(7)));

  const auto error = [&](const std::string& fields) {
    return error_of_bytes("v.nhdr", header + "encoding: raw\n" + fields);
  };
  EXPECT_TRUE(has(error("data file: ../e.raw\n"), "'../e.raw' is not in the folder of the header"));
  EXPECT_TRUE(has(error("data file: ./a/../../e.raw\n"), "is not in the folder of the header"));
  EXPECT_TRUE(has(error("data file: /etc/passwd\n"), "is not in the folder of the header"));
  EXPECT_TRUE(has(error("data file: ..\n"), "is not in the folder of the header"));
  EXPECT_TRUE(has(error("data file:\n"), "is not the name of a data file"));
  EXPECT_TRUE(has(error("data file: LIST\nd.raw\n"), "several files"));
  EXPECT_TRUE(has(error("data file: d%d.raw 1 2 1\n"), "several files"));
  EXPECT_TRUE(has(error("data file: none.raw\n"), "none.raw"));
  EXPECT_TRUE(has(error("data file: d.raw\nline skip: 100\n"), "before the 100 lines to skip"));
  EXPECT_TRUE(has(error("data file: d.raw\nbyte skip: 1000\n"), "before the 1000 bytes to skip"));
  EXPECT_TRUE(has(error("data file: d.raw\nbyte skip: -2\n"), "the byte skip must be"));
  EXPECT_TRUE(has(error(""), "no empty line at its end"));

  // Names of other systems, and of folders that were not sent.
  std::filesystem::create_directory(dir_ / "below");
  write("below/f.raw", bytes);
  write("d.raw", bytes);
  for (const auto& [name, warnings] : {std::pair{"below/f.raw", 0u},
                                       {"below\\f.raw", 0u},
                                       {"./below/f.raw", 0u},
                                       {"../d.raw", 1u},
                                       {"/data/scan/d.raw", 1u},
                                       {"C:\\scan\\d.raw", 1u}}) {
    write("v.nhdr", header + "encoding: raw\ndata file: " + name + "\n");
    EXPECT_EQ(read("v.nhdr").voxels, volume.voxels_not_0()) << name;
    EXPECT_EQ(open("v.nhdr")->warnings().size(), warnings) << name;
  }
}

TEST_F(Nrrd, AFourthAxisOfOneValueIsNone) {
  const RandomVolume<std::uint16_t> volume({4, 3, 2}, 8);
  for (const char* sizes : {"1 4 3 2", "4 3 2 1"}) {
    write("v.nrrd", std::string("NRRD0004\ntype: uint16\nencoding: raw\nendian: little\ndimension: "
                                "4\nsizes: ") +
                        sizes + "\n\n" + volume.bytes());
    EXPECT_EQ(read("v.nrrd").voxels, volume.voxels_not_0()) << sizes;
  }
}

TEST_F(Nrrd, ColorsComeFirst) {
  const std::string header = "NRRD0004\ntype: uint8\nencoding: raw\ndimension: 4\nsizes: ";
  write("v.nrrd", header + "4 2 1 1\nspacings: nan 1 1 1\n\n" +
                      std::string("\x01\x02\x03\x00"
                                  "\x04\x05\x06\x09",
                                  8));
  EXPECT_EQ(read("v.nrrd").voxels, (std::vector<Vec3i>{{1, 0, 0}}));
  EXPECT_EQ(read("v.nrrd").colors, (std::vector<Rgb8>{{4, 5, 6}}));
  write("v.nrrd", header + "3 1 1 2\n\n" + std::string("\x00\x00\x00\x07\x00\x08", 6));
  EXPECT_EQ(read("v.nrrd").voxels, (std::vector<Vec3i>{{0, 0, 1}}));
  EXPECT_EQ(read("v.nrrd").colors, (std::vector<Rgb8>{{7, 0, 8}}));
  EXPECT_TRUE(read("v.nrrd", 9.0).voxels.empty());
}

TEST_F(Nrrd, LayersOfAListAreJoined) {
  const std::string header = "NRRD0004\ntype: short\nencoding: raw\nendian: little\ndimension: 4\n";
  const RandomVolume<std::int16_t> layers({4, 3, 10}, 17);  // x, y and z of 5 voxels, in 2 layers.
  std::vector<Vec3i> joined;
  std::string mixed;  // The layers change fastest.
  for (int z = 0; z < 5; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 4; ++x) {
        const std::int16_t a = layers.at({x, y, z}), b = layers.at({x, y, z + 5});
        if (a != 0 || b != 0) joined.push_back({x, y, z});
        append(mixed, std::uint64_t{static_cast<std::uint16_t>(a)}, 2);
        append(mixed, std::uint64_t{static_cast<std::uint16_t>(b)}, 2);
      }
  write("v.nrrd", header + "sizes: 2 4 3 5\nkinds: list domain domain domain\n\n" + mixed);
  EXPECT_EQ(read("v.nrrd").voxels, joined);
  EXPECT_FALSE(open("v.nrrd")->has_colors());
  write("v.nrrd", header + "sizes: 4 3 5 2\nkinds: domain domain domain list\n\n" + layers.bytes());
  EXPECT_EQ(import("v.nrrd").dag, brute_svdag(3, joined));
  // Four layers of bytes are no colours.
  write("v.nrrd",
        "NRRD0004\ntype: uint8\nencoding: raw\ndimension: 4\nsizes: 4 2 1 1\n"
        "kinds: list domain domain domain\nspace directions: none (1,0,0) (0,1,0) (0,0,1)"
        "\n\n" +
            std::string("\0\1\0\0\2\0\0\0", 8));
  EXPECT_EQ(read("v.nrrd").voxels, (std::vector<Vec3i>{{0, 0, 0}, {1, 0, 0}}));
  EXPECT_FALSE(open("v.nrrd")->has_colors());
}

TEST_F(Nrrd, TheGridIsThatOfTheSpace) {
  const auto open_with = [&](const std::string& fields) {
    write("v.nrrd", "NRRD0004\ntype: uint8\nencoding: raw\ndimension: 3\nsizes: 2 2 2\n" + fields +
                        "\n\n12345678");
    return open("v.nrrd");
  };
  const auto plain = open_with("# nothing");
  EXPECT_EQ(plain->grid()->voxel_size, 1);
  EXPECT_EQ(plain->grid()->origin, (Vec3d{0, 0, 0}));
  const auto spaced = open_with("spacings: 0.5 0.5 0.5");
  EXPECT_EQ(spaced->grid()->voxel_size, 0.5);
  EXPECT_EQ(spaced->grid()->quantization_scale, 512);
  EXPECT_TRUE(spaced->warnings().empty());
  const auto boxes = open_with("spacings: 0.5 0.25 2");
  EXPECT_EQ(boxes->grid()->voxel_size, 0.25);
  ASSERT_EQ(boxes->warnings().size(), 1u);
  EXPECT_EQ(boxes->warnings()[0],
            "the voxels are boxes of 0.5 x 0.25 x 2; they become cubes of side 0.25");
  const auto placed = open_with(
      "space: left-posterior-superior\nspace directions: (2,0,0) (0, 2, 0)\t(0,0,2)\n"
      "space origin: (10,-4,0.5)");
  EXPECT_EQ(placed->grid()->voxel_size, 2);
  EXPECT_EQ(placed->grid()->origin, (Vec3d{9, -5, -0.5}));
  EXPECT_TRUE(placed->warnings().empty());
  // Axes that say where they begin, by their borders or by the centres of their voxels.
  const auto begun = open_with("spacings: 0.5 0.5 0.5\naxis mins: 10 -4 0");
  EXPECT_EQ(begun->grid()->origin, (Vec3d{10, -4, 0}));
  EXPECT_EQ(begun->grid()->voxel_size, 0.5);
  const auto centred =
      open_with("spacings: 0.5 0.5 0.5\naxismins: 10 -4 0\ncenters: node node cell");
  EXPECT_EQ(centred->grid()->origin, (Vec3d{9.75, -4.25, 0}));
  const auto ended =
      open_with("axis mins: 10 -4 nan\naxis maxs: 11 -3 nan\nspace: 3D-right-handed");
  EXPECT_EQ(ended->grid()->voxel_size, 0.5);
  EXPECT_EQ(ended->grid()->origin, (Vec3d{10, -4, 0}));
  const auto with_space =
      open_with("axis mins: 10 -4 0\nspace origin: (1,2,3)\nspace dimension: 3");
  EXPECT_EQ(with_space->grid()->origin, (Vec3d{0.5, 1.5, 2.5}));
  for (const char* along : {"(0,2,0) (2,0,0) (0,0,2)", "(-2,0,0) (0,2,0) (0,0,2)"})
    EXPECT_TRUE(open_with(std::string("space directions: ") + along)->warnings().empty());
  const auto turned = open_with("space directions: (1.6,1.2,0) (0,2,0) (0,0,2)");
  EXPECT_EQ(turned->grid()->voxel_size, 2);
  ASSERT_EQ(turned->warnings().size(), 1u);
  EXPECT_TRUE(has(turned->warnings()[0], "turns or shears"));
}

TEST_F(Nrrd, OtherHeadersAreRefused) {
  const std::string type = "type: uint8\n", raw = "encoding: raw\n", three = "dimension: 3\n";
  const std::string sizes = "sizes: 2 2 2\n", good = type + raw + three + sizes;
  EXPECT_EQ(header_error(good.substr(0, good.size() - 1)), "no error");
  EXPECT_TRUE(has(header_error(raw + three + sizes), "has no field 'type'"));
  EXPECT_TRUE(has(header_error("type: block\n" + raw + three + sizes), "the type 'block' is not"));
  EXPECT_TRUE(has(header_error(type + three + sizes), "has no field 'encoding'"));
  EXPECT_TRUE(
      has(header_error(type + three + sizes + "encoding: bzip2"), "'bzip2' is not supported"));
  EXPECT_TRUE(has(header_error("type: int\nsizes: 1 1 2\n" + raw + three), "no field 'endian'"));
  EXPECT_TRUE(has(header_error(type + raw + sizes + "dimension: 2"), "must have 3 axes, or 4"));
  EXPECT_TRUE(
      has(header_error(type + raw + "sizes: 2 2 2 2\ndimension: 4"), "must have 3 axes, or 4"));
  EXPECT_TRUE(
      has(header_error(type + raw + "sizes: 2 2 2 1\ndimension: 3"), "has 4 values for 3 axes"));
  EXPECT_TRUE(has(header_error(type + raw + three + "sizes: 2 2 -2"), "'-2' is not a number"));
  EXPECT_TRUE(has(header_error(type + raw + three + "sizes: 2 2 0"), "has 0 voxels"));
  EXPECT_TRUE(has(header_error(type + raw + three + "sizes: 2 2 2000000"), "has 2000000 voxels"));
  EXPECT_TRUE(has(header_error(type + raw + three + "sizes: 1000000 1000000 1000000"),
                  "truncated: the volume needs 1000000000000000000 bytes"));
  EXPECT_EQ(header_error(type + raw + three + "sizes: 2 2 1"), "no error");
  EXPECT_TRUE(has(open("v.nrrd")->warnings().at(0), "bytes after the volume are left out: 4"));
  EXPECT_EQ(header_error(good + "sizes: 2 2 2"), "no error");
  EXPECT_TRUE(has(header_error(good + "sizes: 2 2 1"), "the field 'sizes' is there twice"));
  EXPECT_TRUE(has(header_error(good + "spacings: 1 0 1"), "between 1e-30 and 1e30, not 0"));
  EXPECT_TRUE(has(header_error(good + "spacings: 1 -1 1"), "between 1e-30 and 1e30, not -1"));
  EXPECT_TRUE(has(header_error(good + "space origin: (1,2)"), "less than 3 components"));
  EXPECT_TRUE(has(header_error(good + "space origin: (1,2,inf)"), "beyond 1e30"));
  EXPECT_TRUE(has(header_error(good + "space origin: 1 2 3"), "is not a vector"));
  EXPECT_TRUE(has(header_error(good + "what"), "line 6: has no colon"));
  EXPECT_TRUE(has(error_of_bytes("v.nrrd", "NRRD0004\n" + std::string(2'000'000, '#')),
                  "the header is longer than 1 MiB"));
  EXPECT_TRUE(has(error_of_bytes("v.nrrd", "P5 1 1"), "does not begin with \"NRRD\""));
}

TEST_F(Nrrd, LabelsHaveTheNamesOfSegments) {
  write("v.seg.nrrd",
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 1\nencoding: raw\n"
        "Segment0_LabelValue:=2\nSegment0_Name:=liver\nSegment1_Name:=left kidney\n"
        "Segment1_LabelValue:=9\nSegment2_Name:=nameless\n\n" +
            std::string("\2\0\11\3", 4));
  const auto source = open_voxel_source(path("v.seg.nrrd"), {.labels = ""});
  ImportOptions options;
  options.folder = dir_.path();
  const ImportResult result = import_voxels(*source, options);
  EXPECT_EQ(result.labels, (std::vector<Label>{2, 3, 9}));
  EXPECT_EQ(result.label_names, (std::vector<std::string>{"liver", "3", "left kidney"}));
  write("l.nrrd",
        "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 2 2 2 1\nkinds: list domain domain "
        "domain\nencoding: raw\n\n12345678");
  EXPECT_TRUE(has(error_of([&] { open_voxel_source(path("l.nrrd"), {.labels = ""}); }),
                  "labels need one value"));
}

TEST_F(Nrrd, EveryTruncatedOrDamagedFileIsRefusedOrSafe) {
  const RandomVolume<std::uint16_t> volume({3, 2, 4}, 5);
  const std::string header =
      "NRRD0004\ntype: ushort\ndimension: 3\nsizes: 3 2 4\nendian: little\nspacings: 1 2 1\n";
  for (const bool is_gzip : {false, true}) {
    const std::string good = header + "encoding: " + (is_gzip ? "gzip" : "raw") + "\n\n" +
                             (is_gzip ? gzip(volume.bytes()) : volume.bytes());
    expect_no_prefix_is_read("v.nrrd", good);
    EXPECT_GT(flip_every_bit("v.nrrd", good), 300);
  }
}

TEST_F(Nrrd, CompressedDataOfAnotherLengthAreRefused) {
  const std::string header = "NRRD0004\ntype: uint8\ndimension: 3\nencoding: gzip\nsizes: ";
  EXPECT_TRUE(has(error_of_bytes("v.nrrd", header + "2 2 2\n\n" + gzip("123456789")),
                  "longer than the volume"));
  EXPECT_TRUE(has(error_of_bytes("v.nrrd", header + "2 2 2\n\n" + gzip("1234567")), "end early"));
  EXPECT_TRUE(has(error_of_bytes("v.nrrd", header + "1000000 1000000 1000000\n\n" + gzip("1234")),
                  "end early"));
  EXPECT_TRUE(has(error_of_bytes("v.nrrd", header + "2 2 2\nbyte skip: 9000000000000000000\n\n" +
                                               gzip("12345678")),
                  "end early"));
  EXPECT_TRUE(has(error_of_bytes("v.nrrd", header + "2 2 2\n\nnot compressed"), "are damaged"));
  std::string bad_sum = gzip("12345678");
  bad_sum[bad_sum.size() - 5] ^= 1;
  EXPECT_TRUE(has(error_of_bytes("v.nrrd", header + "2 2 2\n\n" + bad_sum), "are damaged"));
}

}  // namespace
}  // namespace voxdag
