// Tests the chunks of attributes: what was written is read, and damaged chunks with correct
// checksums are refused or safe to read.
#include "voxdag/file/attribute_chunks.hpp"

#include <gtest/gtest.h>

#include "support/error_of.hpp"
#include "support/number_colors.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag/file/model/dag_model.hpp"
#include "voxdag/file/verify_vdag.hpp"
#include "voxdag/file/wire_chunks.hpp"
#include "voxdag/stored/attributes/encode_channels.hpp"
#include "voxdag/stored/attributes/look.hpp"
#include "voxdag/stored/compact/encode_svdag.hpp"

namespace voxdag {
namespace {

const Svdag& small_dag() {
  static const Svdag dag = brute_svdag(5, random_voxels(5, 90, 2));
  return dag;
}

const std::vector<std::string> kNames = {"brick", "glass", "", "leaf \"x\"", "wood"};

std::string colored_file(int finest = 5, AttributeForm form = AttributeForm::kPages) {
  const Svdag& dag = small_dag();
  const NumberColors colors(dag.view(), finest);
  VdagMetadata metadata = example_metadata(dag.view());
  metadata.attributes.resolution = std::int64_t{1} << finest;
  metadata.attributes.colors = {0.25, 1234};
  metadata.attributes.normals = {3.5, 99};
  metadata.attributes.materials = kNames;
  const TempDir dir;
  write_vdag(dir / "file.vdag", dag.view(), metadata, colors.view().attributes, form);
  return read_text(dir / "file.vdag");
}

std::string chunk_error_of(const std::string& bytes) {
  return voxdag::error_of([&] { parse_vdag(AlignedBytes(bytes).span()); });
}

VdagChunkEntry entry_of(const std::string& bytes, std::size_t index) {
  return peek<VdagChunkEntry>(bytes, entry_offset(index));
}

/// Reads the attributes of every cell of a file.
void read_all(const VdagContents& contents) {
  const ColoredDagView colored{contents.view, contents.attributes};
  for (int level = 0; level <= colored.dag.levels; ++level)
    for (std::uint64_t code = 0; code < std::uint64_t{1} << 3 * level; ++code) {
      look_at(colored, morton_decode(code), level);
      if (contents.attributes.has_materials()) material_at(colored, morton_decode(code), level);
    }
}

/// Returns the file with a channel instead of the attributes of colored_file().
std::string channel_file(bool compact = false) {
  const Svdag& dag = small_dag();
  DagAttributes attributes;
  attributes.index = build_cell_index(dag.view(), 5);
  std::vector<std::int32_t> codes;
  for (std::uint64_t i = 0; i < attributes.index.cells; ++i)
    codes.push_back(static_cast<std::int32_t>(i * i % 251));
  const EncodedChannel channel = encode_channel({"squares", ChannelKind::kU8, 0}, codes);
  attributes.channels = join_channels(codes.size(), {&channel, 1});
  VdagMetadata metadata = example_metadata(dag.view());
  metadata.attributes.resolution = 32;
  const TempDir dir;
  if (compact)
    write_vdag(dir / "file.vdag", encode_svdag(dag.view()), metadata, attributes.view());
  else
    write_vdag(dir / "file.vdag", dag.view(), metadata, attributes.view());
  return read_text(dir / "file.vdag");
}

constexpr AttributeForm kForms[] = {AttributeForm::kPages, AttributeForm::kWire};

TEST(AttributeChunks, WhatWasWrittenIsRead) {
  for (int run = 0; run < 12; ++run) {
    const int finest = run / 2;
    const AlignedBytes bytes(colored_file(finest, kForms[run % 2]));
    const VdagContents contents = parse_vdag(bytes.span());
    const DagAttributesView& attributes = contents.attributes;
    EXPECT_EQ(attributes.index.finest_level, finest);
    ASSERT_EQ(attributes.colors.values, attributes.index.cells);
    ASSERT_EQ(attributes.normals.values, attributes.index.cells);
    for (std::uint64_t i = 0; i < attributes.index.cells; ++i) {
      EXPECT_EQ(read_value(attributes.colors, i), color_of_number(i));
      EXPECT_EQ(read_value(attributes.normals, i), color_of_number(i));
      EXPECT_EQ(read_material(attributes.materials, i), material_of_number(i));
    }
    EXPECT_EQ(contents.metadata.attributes.materials, kNames);
    EXPECT_EQ(contents.metadata.attributes.resolution, std::int64_t{1} << finest);
    EXPECT_EQ(contents.metadata.attributes.colors->errors, 1234u);
    EXPECT_EQ(contents.metadata.attributes.normals->bound, 3.5);
  }
}

TEST(AttributeChunks, TheGeometryHasTheBytesOfAFileWithoutAttributes) {
  const std::string with = colored_file(), without = vdag_file_bytes(small_dag());
  for (std::size_t i = 1; i < 4; ++i) {  // all chunks but META
    const VdagChunkEntry a = entry_of(with, i), b = entry_of(without, i);
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(with.substr(a.offset, a.length), without.substr(b.offset, b.length));
  }
}

TEST(AttributeChunks, AReaderWithoutAttributesCanSkipThem) {
  const std::string bytes = colored_file();
  for (std::size_t i = 4; i < 8; ++i) EXPECT_EQ(entry_of(bytes, i).flags, 0u);
}

TEST(AttributeChunks, EveryFlippedBitIsRefusedWithoutChecksums) {
  for (const AttributeForm form : kForms) {
    const std::string bytes = colored_file(5, form);
    for (std::size_t i = 4; i < 8; ++i)
      for (std::uint64_t at = 0; at < entry_of(bytes, i).length; ++at) {
        std::string changed = bytes;
        changed[entry_of(bytes, i).offset + at] ^= static_cast<char>(1 << at % 8);
        ASSERT_NE(chunk_error_of(changed), "no error");
      }
  }
}

TEST(AttributeChunks, EveryFlippedBitWithCorrectChecksumsIsRefusedOrSafeToRead) {
  for (const AttributeForm form : kForms) {
    const std::string bytes = colored_file(4, form);
    int refused = 0;
    for (std::size_t i = 4; i < 8; ++i)
      for (std::uint64_t bit = 0; bit < 8 * entry_of(bytes, i).length; ++bit) {
        std::string changed = bytes;
        changed[entry_of(bytes, i).offset + bit / 8] ^= static_cast<char>(1 << bit % 8);
        repair_checksums(changed);
        try {
          const AlignedBytes aligned(changed);
          const VdagContents contents = parse_vdag(aligned.span());
          if (bit % 61 == 0) read_all(contents);
          EXPECT_GT(i, 4u) << "bit " << bit << " of CIDX";
        } catch (const Error&) {
          ++refused;
        }
      }
    EXPECT_GT(refused, 1000);
  }
}

/// Returns the file with the last `cut` bytes of chunk `index` removed, and all offsets, sizes and
/// checksums correct.
std::string shortened(const std::string& bytes, std::size_t index, std::uint64_t cut) {
  std::string file = bytes.substr(0, vdag_align(entry_offset(8)));
  for (std::size_t i = 0; i < 8; ++i) {
    VdagChunkEntry entry = entry_of(bytes, i);
    const std::string chunk = bytes.substr(entry.offset, entry.length - (i == index ? cut : 0));
    entry.offset = file.size();
    entry.length = chunk.size();
    poke(file, entry_offset(i), entry);
    file += chunk;
    file.resize(vdag_align(file.size()));
  }
  poke(file, offsetof(VdagHeader, file_bytes), std::uint64_t{file.size()});
  repair_checksums(file);
  return file;
}

TEST(AttributeChunks, EveryTruncatedChunkIsRefused) {
  for (const AttributeForm form : kForms) {
    const std::string bytes = colored_file(4, form);
    ASSERT_EQ(chunk_error_of(shortened(bytes, 4, 0)), "no error");
    for (std::size_t i = 4; i < 8; ++i)
      for (std::uint64_t cut = 1; cut <= entry_of(bytes, i).length; ++cut)
        ASSERT_NE(chunk_error_of(shortened(bytes, i, cut)), "no error")
            << i << ", " << cut << " bytes";
  }
}

TEST(AttributeChunks, TheWireFormIsNamedAndHasTheSameContents) {
  const std::string pages = colored_file(), wire = colored_file(5, AttributeForm::kWire);
  EXPECT_LT(wire.size(), pages.size());
  EXPECT_EQ(entry_of(wire, 5).id, kChunkWireColors);
  EXPECT_EQ(entry_of(wire, 6).id, kChunkWireNormals);
  EXPECT_EQ(entry_of(wire, 7).id, kChunkWireMaterials);
  const AlignedBytes bytes(wire);
  const VdagContents contents = parse_vdag(bytes.span());
  for (std::size_t i = 0; i < 8; ++i) {
    const VdagChunkEntry entry = entry_of(pages, i);
    const auto read = find_chunk(contents.chunks, entry.id)->bytes;
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(read.data()), read.size()),
              pages.substr(entry.offset, entry.length));
  }
  const TempDir dir;
  write_text(dir / "wire.vdag", wire);
  write_text(dir / "pages.vdag", pages);
  const WireBytes sizes = wire_bytes_of(VdagContainer(dir / "wire.vdag"));
  EXPECT_EQ(sizes.colors, entry_of(wire, 5).length);
  EXPECT_EQ(sizes.normals, entry_of(wire, 6).length);
  EXPECT_EQ(sizes.materials, entry_of(wire, 7).length);
  EXPECT_EQ(sizes.expanded,
            entry_of(pages, 5).length + entry_of(pages, 6).length + entry_of(pages, 7).length);
  EXPECT_EQ(wire_bytes_of(VdagContainer(dir / "pages.vdag")).expanded, 0u);
}

TEST(AttributeChunks, AWireChunkThatExpandsTooFarIsRefused) {
  std::string bytes = colored_file(5, AttributeForm::kWire);
  const VdagChunkEntry entry = entry_of(bytes, 5);
  poke(bytes, entry.offset + offsetof(WireHeader, words), 8 * entry.length + 1);
  repair_checksums(bytes);
  EXPECT_NE(chunk_error_of(bytes).find("chunk WCOL: expands to"), std::string::npos)
      << chunk_error_of(bytes);
  poke(bytes, entry.offset + offsetof(WireHeader, words), std::uint64_t{0});
  repair_checksums(bytes);
  EXPECT_NE(chunk_error_of(bytes).find("chunk WCOL: has too few words"), std::string::npos)
      << chunk_error_of(bytes);
}

TEST(AttributeChunks, ColoursInBothFormsAreRefused) {
  std::string bytes = colored_file(5, AttributeForm::kWire);
  VdagChunkEntry entry = entry_of(bytes, 7);
  entry.id = kChunkColors;
  poke(bytes, entry_offset(7), entry);
  repair_checksums(bytes);
  EXPECT_NE(chunk_error_of(bytes).find("WCOL: stands for the chunk COLR"), std::string::npos)
      << chunk_error_of(bytes);
}

TEST(AttributeChunks, ColoursWithoutNumbersAreRefused) {
  std::string bytes = colored_file();
  VdagChunkEntry entry = entry_of(bytes, 4);
  entry.id = vdag_chunk_id("XXXX");
  poke(bytes, entry_offset(4), entry);
  repair_checksums(bytes);
  EXPECT_NE(chunk_error_of(bytes).find("COLR: needs the chunk CIDX"), std::string::npos)
      << chunk_error_of(bytes);
}

TEST(AttributeChunks, ChannelsAreReadInBothForms) {
  const TempDir dir;
  for (const bool compact : {false, true}) {
    write_text(dir / "file.vdag", channel_file(compact));
    const DagModel model(dir / "file.vdag");
    const ChannelsView channels = model.attributes().channels;
    ASSERT_EQ(channels.count(), 1u);
    EXPECT_EQ(channels[0].name(), "squares");
    ASSERT_EQ(channels[0].values, model.attributes().index.cells);
    for (std::uint64_t i = 0; i < channels[0].values; ++i)
      ASSERT_EQ(channels[0].read(i), static_cast<double>(i * i % 251));
    EXPECT_TRUE(compact || verify_vdag(dir / "file.vdag").passed());
  }
}

TEST(AttributeChunks, ABrokenChannelIsRefusedWithItsPlace) {
  std::string bytes = channel_file();
  const VdagChunkEntry entry = entry_of(bytes, 5);
  ASSERT_EQ(entry.id, kChunkChannels);
  poke(bytes, entry.offset + offsetof(ChannelsHeader, values), std::uint64_t{7});
  repair_checksums(bytes);
  EXPECT_NE(chunk_error_of(bytes).find("chunk CHAN: has 7 values"), std::string::npos)
      << chunk_error_of(bytes);
  bytes = channel_file();
  poke(bytes, entry.offset + 64 + 128, std::uint64_t{1});
  repair_checksums(bytes);
  EXPECT_EQ(chunk_error_of(bytes),
            "chunk CHAN, channel 0, block 0: does not begin where the block before it ends");
}

}  // namespace
}  // namespace voxdag
