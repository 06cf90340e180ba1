#include "voxdag/cluster/node_order.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "voxdag/cluster/mailboxes.hpp"
#include "voxdag/cluster/node_record.hpp"
#include "voxdag/cluster/ordered_level.hpp"
#include "voxdag/core/int128.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/svdag/long_svdag.hpp"

namespace voxdag {
namespace {

/// A reference to a child of number `number`, the `position`-th of its level.
struct Reference {
  std::uint64_t number, position, copies;
};

/// A node of number `number` of mailbox `mailbox`, whose first reference is at `position`. Its
/// record follows.
struct FirstReference {
  std::uint64_t number, position, copies;
  std::uint64_t mailbox;
};

/// The place of a node in its level: the offset of its first word, or the index of its leaf block.
struct Place {
  std::uint64_t number, place;
};

/// The place of the child that reference `position` names.
struct PlacedReference {
  std::uint64_t position, place;
};

std::string name_of(const char* kind, int level) {
  return "merge/" + std::string(kind) + "-" + std::to_string(level);
}
class NodeOrder {
 public:
  explicit NodeOrder(const MergeJob& job) : job_(job), leaf_level_(job.levels - 2) {}

  /// Writes level 0: the root alone.
  void begin(std::uint64_t root) {
    const auto root_box = static_cast<std::uint32_t>(root % job_.mailboxes);
    Mailboxes mail(job_.ranks, job_.folder, name_of("order", 0), job_.mailboxes, *job_.work.memory);
    for_each_own(mail, [&](std::uint32_t box, Mailboxes::Sender& sender) {
      if (box != root_box) return;
      const WorkFile file = job_.folder.open_written(merged_name(0, box), job_.work);
      const std::byte* at = file.bytes().data();
      for (std::uint64_t number = root / job_.mailboxes; number > 0; --number)
        at += record_bytes(at, leaf_level_ == 0);
      sender.send_value(0, OrderedNode{1});
      sender.send(0, {at, static_cast<std::size_t>(record_bytes(at, leaf_level_ == 0))});
    });
    mail.close();
  }

  /// Orders level + 1, and writes the words of `level`.
  void advance(int level) {
    const std::string references = name_of("references", level),
                      firsts = name_of("firsts", level + 1), places = name_of("places", level + 1),
                      placed = name_of("placed", level);
    const LevelRuns runs = runs_of(job_, level);
    send_references(level, runs, references);
    send_firsts(level, runs, references, firsts);
    order_runs(level + 1, firsts, places);
    const LevelRuns below = runs_of(job_, level + 1);
    answer_references(level, runs, references, places, placed);
    write_words(level, runs, below, placed);
    for_each_own([&](std::uint32_t box) {
      for (const std::string& name : {references, firsts, places, placed})
        job_.folder.remove(mailbox_name(name, box));
    });
  }

  /// Writes the leaf blocks.
  void finish() {
    for_each_own([&](std::uint32_t box) {
      const WorkFile file = job_.folder.open_written(order_name(leaf_level_, box), job_.work);
      WorkFileWriter out = job_.folder.create(words_name(leaf_level_, box));
      for_each_node(file, true, job_.work, [&](const OrderedNode&, const std::byte* record) {
        out.write({record, kLeafRecordBytes});
      });
      out.commit();
    });
    job_.ranks.barrier();
  }

 private:
  /// Calls body(mailbox) for the mailboxes of this rank, on all threads.
  template <class Body>
  void for_each_own(const Body& body) {
    voxdag::for_each_own(job_.ranks, job_.mailboxes, job_.work, body);
  }
  /// Calls body(mailbox, sender).
  template <class Body>
  void for_each_own(Mailboxes& mail, const Body& body) {
    for_each_own([&](std::uint32_t box) {
      Mailboxes::Sender sender(mail);
      body(box, sender);
      sender.flush();
    });
  }

  template <class T, class Body>
  void for_each_message(const WorkFile& file, const Body& body) {
    const std::span<const T> all = file.values<T>();
    for (std::size_t i = 0; i < all.size(); ++i) {
      job_.work.poll_seldom(i);
      if ((i & 0xFFFFF) == 0xFFFFF) file.release(i * sizeof(T));
      body(all[i]);
    }
  }

  /// Returns the run of the level below that a reference's position is in.
  std::uint32_t run_of(std::uint64_t position, std::uint64_t references) const {
    return static_cast<std::uint32_t>(static_cast<Uint128>(position) * job_.mailboxes / references);
  }

  void send_references(int level, const LevelRuns& runs, const std::string& name) {
    Mailboxes mail(job_.ranks, job_.folder, name, job_.mailboxes, *job_.work.memory);
    for_each_own(mail, [&](std::uint32_t box, Mailboxes::Sender& sender) {
      const WorkFile file = job_.folder.open_written(order_name(level, box), job_.work);
      std::uint64_t position = runs.first_reference[box];
      for_each_node(file, false, job_.work, [&](const OrderedNode& node, const std::byte* record) {
        for (int i = 0; i < record_ids(record, false); ++i) {
          const std::uint64_t id = record_id(record, i);
          sender.send_value(static_cast<std::uint32_t>(id % job_.mailboxes),
                            Reference{id / job_.mailboxes, position++, node.copies});
        }
      });
    });
    mail.close();
  }

  /// Finds the first reference to each node of level + 1, and sends the node to its run.
  void send_firsts(int level, const LevelRuns& runs, const std::string& references,
                   const std::string& firsts) {
    constexpr std::uint64_t kNever = ~std::uint64_t{0};
    Mailboxes mail(job_.ranks, job_.folder, firsts, job_.mailboxes, *job_.work.memory);
    const bool is_leaf = level + 1 == leaf_level_;
    for_each_own(mail, [&](std::uint32_t box, Mailboxes::Sender& sender) {
      const WorkFile nodes = job_.folder.open_written(merged_name(level + 1, box), job_.work);
      PageVector<std::uint64_t> first(job_.work.memory), copies(job_.work.memory);
      const std::byte* at = nodes.bytes().data();
      const std::byte* const end = at + nodes.bytes().size();
      for (; at != end; at += record_bytes(at, is_leaf)) first.push_back(kNever);
      copies.resize(first.size());
      std::fill(copies.begin(), copies.end(), 0);
      for_each_message<Reference>(
          job_.folder.open_written(mailbox_name(references, box), job_.work),
          [&](const Reference& reference) {
            first[reference.number] = std::min(first[reference.number], reference.position);
            copies[reference.number] += reference.copies;
          });
      at = nodes.bytes().data();
      for (std::uint64_t number = 0; number < first.size(); ++number) {
        const auto size = static_cast<std::size_t>(record_bytes(at, is_leaf));
        std::byte message[sizeof(FirstReference) + kMaxRecordBytes];
        const FirstReference head{number, first[number], copies[number], box};
        std::memcpy(message, &head, sizeof head);
        std::memcpy(message + sizeof head, at, size);
        sender.send(run_of(first[number], runs.first_reference.back()),
                    {message, sizeof head + size});
        at += size;
      }
    });
    mail.close();
  }

  /// Sorts the runs of a level, and tells the owners of the nodes where in its run each went.
  void order_runs(int level, const std::string& firsts, const std::string& places) {
    struct Entry {
      std::uint64_t position, begin;
    };
    const bool is_leaf = level == leaf_level_;
    Mailboxes mail(job_.ranks, job_.folder, places, job_.mailboxes, *job_.work.memory);
    for_each_own(mail, [&](std::uint32_t box, Mailboxes::Sender& sender) {
      const WorkFile file = job_.folder.open_written(mailbox_name(firsts, box), job_.work);
      PageVector<Entry> entries(job_.work.memory);
      const std::byte* const begin = file.bytes().data();
      for (const std::byte *at = begin, *end = at + file.bytes().size(); at != end;) {
        const std::byte* const message = at;
        const auto head = take_value<FirstReference>(at);
        at += record_bytes(at, is_leaf);
        entries.push_back({head.position, static_cast<std::uint64_t>(message - begin)});
      }
      std::sort(entries.begin(), entries.end(),
                [](const Entry& a, const Entry& b) { return a.position < b.position; });
      WorkFileWriter out = job_.folder.create(order_name(level, box));
      std::uint64_t place = 0;
      for (std::size_t i = 0; i < entries.size(); ++i) {
        job_.work.poll_seldom(i);
        const std::byte* at = begin + entries[i].begin;
        const auto head = take_value<FirstReference>(at);
        out.write_value(OrderedNode{head.copies});
        out.write({at, static_cast<std::size_t>(record_bytes(at, is_leaf))});
        // The run's number in the upper bits: where the run begins is not known yet.
        sender.send_value(static_cast<std::uint32_t>(head.mailbox),
                          Place{head.number, std::uint64_t{box} << kPlaceBits | place});
        place += is_leaf ? 1 : 1 + static_cast<std::uint64_t>(record_ids(at, false));
      }
      out.commit();
    });
    mail.close();
  }

  /// Sends the place of each child to the run that refers to it.
  void answer_references(int, const LevelRuns& runs, const std::string& references,
                         const std::string& places, const std::string& placed) {
    Mailboxes mail(job_.ranks, job_.folder, placed, job_.mailboxes, *job_.work.memory);
    for_each_own(mail, [&](std::uint32_t box, Mailboxes::Sender& sender) {
      PageVector<std::uint64_t> place_of(job_.work.memory);
      const WorkFile answers = job_.folder.open_written(mailbox_name(places, box), job_.work);
      place_of.resize(answers.values<Place>().size());
      for_each_message<Place>(answers,
                              [&](const Place& place) { place_of[place.number] = place.place; });
      for_each_message<Reference>(
          job_.folder.open_written(mailbox_name(references, box), job_.work),
          [&](const Reference& reference) {
            const auto run = std::upper_bound(runs.first_reference.begin(),
                                              runs.first_reference.end() - 1, reference.position) -
                             runs.first_reference.begin() - 1;
            sender.send_value(static_cast<std::uint32_t>(run),
                              PlacedReference{reference.position, place_of[reference.number]});
          });
    });
    mail.close();
  }

  /// Writes the words of a level.
  void write_words(int level, const LevelRuns& runs, const LevelRuns& below,
                   const std::string& placed) {
    if (below.first_place.back() > kMaxLongWords)
      throw Error(
          "the DAG is too large: one level has more words than 35-bit pointers can address");
    for_each_own([&](std::uint32_t box) {
      PageVector<std::uint64_t> pointers(job_.work.memory);
      const std::uint64_t first = runs.first_reference[box];
      pointers.resize(runs.first_reference[box + 1] - first);
      for_each_message<PlacedReference>(
          job_.folder.open_written(mailbox_name(placed, box), job_.work),
          [&](const PlacedReference& reference) {
            const std::uint64_t run = reference.place >> kPlaceBits,
                                place = reference.place & ((std::uint64_t{1} << kPlaceBits) - 1);
            pointers[reference.position - first] = below.first_place[run] + place;
          });
      const WorkFile file = job_.folder.open_written(order_name(level, box), job_.work);
      WorkFileWriter out = job_.folder.create(words_name(level, box));
      std::uint64_t next = 0;
      for_each_node(file, false, job_.work, [&](const OrderedNode&, const std::byte* record) {
        std::uint32_t words[9] = {static_cast<std::uint32_t>(*record)};
        std::size_t size = 1;
        for (std::uint32_t left = words[0]; left != 0; left &= left - 1) {
          const std::uint64_t pointer = pointers[next++];
          words[0] |= upper_bits_of(pointer, std::countr_zero(left));
          words[size++] = static_cast<std::uint32_t>(pointer);
        }
        out.write(std::as_bytes(std::span<const std::uint32_t>(words, size)));
      });
      out.commit();
    });
    job_.ranks.barrier();
  }

  /// Bits of a place within its run.
  static constexpr int kPlaceBits = 48;

  const MergeJob& job_;
  int leaf_level_;
};

}  // namespace

std::string words_name(int level, std::uint32_t mailbox) {
  return mailbox_name(name_of("words", level), mailbox);
}

OrderedDag order_nodes(const MergeJob& job, const MergedNodes& merged) {
  const int leaf_level = job.levels - 2;
  OrderedDag dag;
  dag.level_begin.assign(static_cast<std::size_t>(leaf_level) + 1, 0);
  dag.counts.svo_nodes_per_level.assign(static_cast<std::size_t>(job.levels), 0);
  dag.counts.dag_nodes_per_level = dag.counts.svo_nodes_per_level;
  if (merged.is_empty) return dag;
  dag.counts = {};
  NodeOrder order(job);
  const auto run_once = [&](const std::string& step, const auto& body) {
    if (is_done_for_all(job.ranks, job.folder, step)) return;
    body();
    mark_done_for_all(job.ranks, job.folder, step);
  };
  run_once("order-0", [&] { order.begin(merged.root); });
  for (int level = 0; level <= leaf_level; ++level) {
    run_once("order-" + std::to_string(level + 1), [&] {
      job.work.report("number", level / (leaf_level + 1.0));
      level == leaf_level ? order.finish() : order.advance(level);
    });
    const LevelRuns runs = runs_of(job, level);
    dag.counts.dag_nodes_per_level.push_back(runs.nodes);
    dag.counts.svo_nodes_per_level.push_back(runs.copies);
    if (level < leaf_level) {
      const std::uint64_t words = runs.first_place.back();
      dag.level_begin[static_cast<std::size_t>(level) + 1] =
          dag.level_begin[static_cast<std::size_t>(level)] + words;
    } else {
      dag.leaf_blocks = runs.nodes;
    }
  }
  dag.has_long_pointers = dag.level_begin.back() > job.most_plain_words;
  count_leaves(job, dag.counts);
  return dag;
}

}  // namespace voxdag
