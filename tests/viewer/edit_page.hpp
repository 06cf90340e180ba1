#pragma once
/// A page that edits a scene: sends requests, and keeps a copy of the DAG up to date.
#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "http_client.hpp"
#include "voxdag/algebra/crop.hpp"
#include "voxdag/edit/edit_nodes.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"

namespace voxdag {

/// Returns the request of a page of the server at `port`.
inline std::string edit_request(int port, const std::string& path, const std::string& token,
                                std::uint32_t writer, const std::string& body = {}) {
  const std::string host = "127.0.0.1:" + std::to_string(port);
  return "POST /edit/" + path + " HTTP/1.1\r\nHost: " + host + "\r\nOrigin: http://" + host +
         "\r\nVoxdag-Token: " + token + "\r\nVoxdag-Writer: " + std::to_string(writer) +
         "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

/// A copy of the arrays of an EditableDag, which updates keep up to date.
class EditMirror {
 public:
  explicit EditMirror(const SvdagView& base)
      : view_(base),
        words_(base.nodes, base.nodes + base.node_words()),
        blocks_(base.leaf_blocks, base.leaf_blocks + base.leaf_block_count) {}

  /// Takes the bytes of an EditUpdate (viewer/edit/edit_update.hpp).
  void take(const std::string& bytes) {
    std::vector<std::uint32_t> all(bytes.size() / 4);
    std::memcpy(all.data(), bytes.data(), 4 * all.size());
    ASSERT_GE(all.size(), 10u);
    writer = all[0];
    root = all[1];
    undos = all[5];
    redos = all[6];
    const std::size_t words = all[7], blocks = all[8], runs = words + blocks + all[9];
    std::size_t at = 10 + 2 * runs;
    for (std::size_t i = 0; i < runs; ++i) {
      const std::uint32_t first = all[10 + 2 * i], count = all[11 + 2 * i];
      const std::size_t size = std::size_t{count} * (i >= words && i < words + blocks ? 2 : 1);
      ASSERT_LE(at + size, all.size());
      if (i < words) {
        words_.resize(std::max<std::size_t>(words_.size(), first + count));
        std::copy_n(&all[at], size, &words_[first]);
      } else if (i < words + blocks) {
        blocks_.resize(std::max<std::size_t>(blocks_.size(), first + count));
        std::memcpy(&blocks_[first], &all[at], 4 * size);
      }
      at += size;
    }
    EXPECT_EQ(at, all.size());
  }

  /// Returns the voxels that the page shows.
  Svdag dag() const {
    SvdagView shown = view_;
    shown.nodes = words_.data();
    shown.leaf_blocks = blocks_.data();
    shown.root = root == EditNodes::kNone ? 0 : root;
    shown.leaf_block_count = root == EditNodes::kNone ? 0 : blocks_.size();
    return crop(shown, whole_grid(view_.levels));
  }

  std::uint32_t writer = 0, root = 0, undos = 0, redos = 0;

 private:
  SvdagView view_;
  std::vector<std::uint32_t> words_;
  std::vector<std::uint64_t> blocks_;
};

}  // namespace voxdag
