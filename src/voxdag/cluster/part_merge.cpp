#include "voxdag/cluster/part_merge.hpp"

#include <algorithm>
#include <map>

#include "voxdag/cluster/mailboxes.hpp"
#include "voxdag/cluster/node_record.hpp"
#include "voxdag/cluster/unique_records.hpp"
#include "voxdag/core/int128.hpp"
#include "voxdag/core/io/checksum.hpp"
#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {
namespace {

/// The part of a question about a node above the pieces; its place is its Morton code.
constexpr std::uint32_t kTop = ~std::uint32_t{0};

std::string ids_name(int level, std::uint32_t box) {
  return "merge/ids-" + std::to_string(level) + "-" + std::to_string(box);
}
std::string top_name(int level) { return "merge/top-" + std::to_string(level); }

/// The pages of files are dropped from memory after so many nodes.
constexpr std::uint64_t kRelease = std::uint64_t{1} << 20;

/// Asks for the id of a node; the record follows.
struct Question {
  std::uint32_t part, piece;
  std::uint64_t place;  ///< Index of the leaf block, or of the node's first word in its level.
};
/// Answers a question.
struct Answer {
  std::uint32_t part, piece;
  std::uint64_t place, id;
};

/// Returns the places of a level of a DAG: its leaf blocks, or the words of its nodes.
std::uint64_t places_of(const SvdagView& dag, int level) {
  return level == dag.levels - 2 ? dag.leaf_block_count
                                 : dag.level_begin[level + 1] - dag.level_begin[level];
}

/// A cell above the pieces, or the root of a piece: its Morton code and the id of its node.
struct TopCell {
  std::uint64_t code, id;
};

/// Calls body(code, place) for the cells of `level` that a DAG has.
template <class Body>
void for_each_cell(const SvdagView& dag, int level, const Body& body) {
  const auto walk = [&](const auto& self, int at_level, std::uint64_t code,
                        std::uint64_t pointer) -> void {
    const bool is_leaf = at_level == dag.levels - 2;
    if (at_level == level) return body(code, is_leaf ? pointer : pointer - dag.level_begin[level]);
    const std::uint32_t* const node = dag.nodes + pointer;
    for (int child = 0; child < 8; ++child)
      if (child_mask(node) >> child & 1)
        self(self, at_level + 1, code << 3 | static_cast<unsigned>(child),
             child_pointer(node, child));
  };
  walk(walk, 0, 0, 0);
}

class LevelMerge {
 public:
  LevelMerge(const MergeJob& job, int level)
      : job_(job), level_(level), is_leaf_(level == job.levels - 2) {}

  void run() {
    const std::string cells = "merge/cells-" + std::to_string(level_);
    const std::string questions = "merge/questions-" + std::to_string(level_),
                      answers = "merge/answers-" + std::to_string(level_);
    ask(questions);
    intern(questions, answers);
    collect(answers, cells);
    voxdag::for_each_own(job_.ranks, job_.mailboxes, {}, [&](std::uint32_t box) {
      job_.folder.remove(mailbox_name(questions, box));
      job_.folder.remove(mailbox_name(answers, box));
      job_.folder.remove(mailbox_name(cells, box));
    });
  }

 private:
  /// Calls body(mailbox, sender) for the mailboxes of this rank, on all threads.
  template <class Body>
  void for_each_own(Mailboxes& mail, const Body& body) {
    voxdag::for_each_own(job_.ranks, job_.mailboxes, job_.work, [&](std::uint32_t box) {
      Mailboxes::Sender sender(mail);
      body(box, sender);
      sender.flush();
    });
  }

  /// Calls body(number, PartFile) for the parts of a mailbox.
  template <class Body>
  void for_each_part(std::uint32_t box, const Body& body) {
    for (std::uint64_t p = box; p < job_.parts.count(); p += job_.mailboxes) {
      const PartFile& part = job_.parts.get(p);
      body(static_cast<std::uint32_t>(p), part);
      part.release();
    }
  }

  /// Sends the nodes of the level to their owners.
  void ask(const std::string& questions) {
    Mailboxes mail(job_.ranks, job_.folder, questions, job_.mailboxes, *job_.work.memory);
    for_each_own(mail, [&](std::uint32_t box, Mailboxes::Sender& sender) {
      std::optional<WorkFile> ids;
      if (!is_leaf_) ids = job_.folder.open_written(ids_name(level_ + 1, box), job_.work);
      std::uint64_t first = 0;
      for_each_part(box, [&](std::uint32_t p, const PartFile& part) {
        for (std::uint32_t i = 0; i < part.pieces.size(); ++i) {
          const PartPiece& piece = part.pieces[i];
          // Above its range, a piece has nodes that other pieces share.
          if (level_ >= piece.range.level)
            ask_piece({p, i, 0}, part, piece.dag,
                      ids ? ids->values<std::uint64_t>().subspan(first)
                          : std::span<const std::uint64_t>(),
                      sender);
          if (level_ + 1 >= piece.range.level && !is_leaf_)
            first += places_of(piece.dag, level_ + 1);
        }
      });
    });
    if (job_.ranks.rank() == 0 && !is_leaf_) {
      Mailboxes::Sender sender(mail);
      ask_top(sender);
      sender.flush();
    }
    mail.close();
  }

  /// Asks for the nodes above the pieces, from the cells of the level below.
  void ask_top(Mailboxes::Sender& sender) {
    const WorkFile file = job_.folder.open_written(top_name(level_ + 1), job_.work);
    const auto cells = file.values<TopCell>();
    for (std::size_t i = 0; i < cells.size();) {
      Question question{kTop, 0, cells[i].code >> 3};
      std::byte record[kMaxRecordBytes];
      int ids = 0;
      unsigned mask = 0;
      for (; i < cells.size() && cells[i].code >> 3 == question.place; ++i) {
        mask |= 1u << (cells[i].code & 7);
        store_id(record + 1 + kIdBytes * ids++, cells[i].id);
      }
      record[0] = static_cast<std::byte>(mask);
      send(question, {record, static_cast<std::size_t>(1 + kIdBytes * ids)}, sender);
    }
  }

  /// Sends a question to the owner of the node.
  void send(const Question& question, std::span<const std::byte> record,
            Mailboxes::Sender& sender) {
    std::byte message[sizeof question + kMaxRecordBytes];
    std::memcpy(message, &question, sizeof question);
    std::memcpy(message + sizeof question, record.data(), record.size());
    sender.send(owner(xxh3_64(record)), {message, sizeof question + record.size()});
  }

  void ask_piece(Question question, const PartFile& part, const SvdagView& dag,
                 std::span<const std::uint64_t> children, Mailboxes::Sender& sender) {
    std::byte record[kMaxRecordBytes];
    if (is_leaf_) {
      for (std::uint64_t i = 0; i < dag.leaf_block_count; ++i) {
        job_.work.poll_seldom(i);
        if (i % kRelease == kRelease - 1) part.release();
        question.place = i;
        std::memcpy(record, &dag.leaf_blocks[i], kLeafRecordBytes);
        send(question, {record, kLeafRecordBytes}, sender);
      }
      return;
    }
    const std::uint64_t begin = dag.level_begin[level_], end = dag.level_begin[level_ + 1];
    // Pointers to leaf blocks count from 0, others from the first word of all.
    const std::uint64_t base = level_ + 1 == dag.levels - 2 ? 0 : dag.level_begin[level_ + 1];
    std::uint64_t count = 0;
    for (std::uint64_t at = begin; at < end;) {
      job_.work.poll_seldom(++count);
      if (count % kRelease == 0) part.release();
      const auto mask = static_cast<std::uint8_t>(child_mask(dag.nodes + at));
      const int ids = std::popcount(mask);
      question.place = at - begin;
      record[0] = std::byte{mask};
      for (int i = 0; i < ids; ++i)
        store_id(record + 1 + i * kIdBytes,
                 children[dag.nodes[at + 1 + static_cast<unsigned>(i)] - base]);
      send(question, {record, static_cast<std::size_t>(node_record_bytes(mask))}, sender);
      at += 1 + static_cast<std::uint64_t>(ids);
    }
  }

  std::uint32_t owner(std::uint64_t hash) const {
    return static_cast<std::uint32_t>(static_cast<Uint128>(hash) * job_.mailboxes >> 64);
  }

  /// Gives equal nodes one id, and answers.
  void intern(const std::string& questions, const std::string& answers) {
    Mailboxes mail(job_.ranks, job_.folder, answers, job_.mailboxes, *job_.work.memory);
    for_each_own(mail, [&](std::uint32_t box, Mailboxes::Sender& sender) {
      const WorkFile file = job_.folder.open_written(mailbox_name(questions, box), job_.work);
      UniqueRecords nodes(job_.work.memory);
      const std::span<const std::byte> bytes = file.bytes();
      std::uint64_t count = 0;
      for (std::size_t at = 0; at < bytes.size();) {
        if ((++count & 0xFFFFF) == 0) file.release(at);
        job_.work.poll_seldom(count);
        Question question;
        std::memcpy(&question, bytes.data() + at, sizeof question);
        at += sizeof question;
        const auto record =
            bytes.subspan(at, static_cast<std::size_t>(record_bytes(bytes.data() + at, is_leaf_)));
        at += record.size();
        const std::uint64_t number = nodes.find_or_add(record, xxh3_64(record));
        if (number >= kMaxIds / job_.mailboxes)
          throw Error("the DAG is too large: one level has more than 2^40 nodes");
        const Answer answer{question.part, question.piece, question.place,
                            number * job_.mailboxes + box};
        sender.send_value(question.part == kTop ? 0 : question.part % job_.mailboxes, answer);
      }
      WorkFileWriter out = job_.folder.create(merged_name(level_, box));
      out.write(nodes.bytes());
      out.commit();
    });
    mail.close();
  }

  /// Stores the ids of the nodes of each part, and the cells of the level above which the pieces
  /// share nodes.
  void collect(const std::string& answers, const std::string& cells) {
    Mailboxes mail(job_.ranks, job_.folder, cells, job_.mailboxes, *job_.work.memory);
    for_each_own(mail, [&](std::uint32_t box, Mailboxes::Sender& sender) {
      std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t> first;
      std::uint64_t count = 0;
      for_each_part(box, [&](std::uint32_t p, const PartFile& part) {
        for (std::uint32_t i = 0; i < part.pieces.size(); ++i) {
          if (level_ < part.pieces[i].range.level) continue;
          first[{p, i}] = count;
          count += places_of(part.pieces[i].dag, level_);
        }
      });
      PageVector<std::uint64_t> ids(job_.work.memory);
      ids.resize(count);
      const WorkFile file = job_.folder.open_written(mailbox_name(answers, box), job_.work);
      const auto all = file.values<Answer>();
      for (std::size_t i = 0; i < all.size(); ++i) {
        if ((i & 0xFFFFF) == 0) file.release(i * sizeof(Answer));
        job_.work.poll_seldom(i);
        if (all[i].part == kTop)
          sender.send_value(0, TopCell{all[i].place, all[i].id});
        else
          ids[first.at({all[i].part, all[i].piece}) + all[i].place] = all[i].id;
      }
      for_each_part(box, [&](std::uint32_t p, const PartFile& part) {
        for (std::uint32_t i = 0; i < part.pieces.size(); ++i)
          if (part.pieces[i].range.level == level_)
            for_each_cell(part.pieces[i].dag, level_, [&](std::uint64_t code, std::uint64_t place) {
              sender.send_value(0, TopCell{code, ids[first.at({p, i}) + place]});
            });
      });
      WorkFileWriter out = job_.folder.create(ids_name(level_, box));
      out.write(std::as_bytes(std::span<const std::uint64_t>(ids.data(), ids.size())));
      out.commit();
    });
    mail.close();
    if (job_.ranks.rank() == 0) write_top(mailbox_name(cells, 0));
    job_.ranks.barrier();
  }

  void write_top(const std::string& cells) {
    const WorkFile file = job_.folder.open_written(cells, job_.work);
    const auto all = file.values<TopCell>();
    std::vector<TopCell> sorted(all.begin(), all.end());
    std::sort(sorted.begin(), sorted.end(),
              [](const TopCell& a, const TopCell& b) { return a.code < b.code; });
    WorkFileWriter out = job_.folder.create(top_name(level_));
    out.write(std::as_bytes(std::span<const TopCell>(sorted)));
    out.commit();
  }

  const MergeJob& job_;
  int level_;
  bool is_leaf_;
};

}  // namespace

std::string merged_name(int level, std::uint32_t mailbox) {
  return "merge/nodes-" + std::to_string(level) + "-" + std::to_string(mailbox);
}

std::uint32_t mailboxes_for(Ranks& ranks, PartFiles& parts, const MemoryBudget& budget) {
  // A leaf block takes its record, its slot in a table and its first reference; so does a word of
  // a node, on average.
  constexpr std::uint64_t kNodeBytes = 64, kWordBytes = 24;
  std::vector<std::uint64_t> bytes(kMaxLevels);
  for (auto p = static_cast<std::uint64_t>(ranks.rank()); p < parts.count();
       p += static_cast<std::uint64_t>(ranks.count()))
    for (const PartPiece& piece : parts.get(p).pieces)
      for (int level = 0; level <= piece.dag.levels - 2; ++level)
        bytes[static_cast<std::size_t>(level)] +=
            places_of(piece.dag, level) * (level == piece.dag.levels - 2 ? kNodeBytes : kWordBytes);
  std::uint64_t most = 0;
  const std::vector<std::uint64_t> all = ranks.all_gather(bytes);
  for (std::size_t level = 0; level < bytes.size(); ++level) {
    std::uint64_t sum = 0;
    for (std::size_t i = level; i < all.size(); i += bytes.size()) sum += all[i];
    most = std::max(most, sum);
  }
  return mailboxes_of(ranks, most, budget);
}

MergedNodes merge_parts(const MergeJob& job) {
  for (int level = job.levels - 2; level >= 0; --level) {
    const std::string step = "merge-" + std::to_string(level);
    if (!is_done_for_all(job.ranks, job.folder, step)) {
      job.work.report("merge", 1 - (level + 1.0) / (job.levels - 1));
      LevelMerge(job, level).run();
      mark_done_for_all(job.ranks, job.folder, step);
      // Until then, a new run needs them to merge this level again.
      for_each_own(job.ranks, job.mailboxes, {},
                   [&](std::uint32_t box) { job.folder.remove(ids_name(level + 1, box)); });
    }
  }
  const WorkFile file = job.folder.open_written(top_name(0), job.work);
  const auto root = file.values<TopCell>();
  if (root.empty()) return {};
  return {root[0].id, false};
}

}  // namespace voxdag
