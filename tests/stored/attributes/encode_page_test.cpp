#include "voxdag/stored/attributes/encode_page.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <thread>
#include <vector>

#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/stored/attributes/fit_block.hpp"
#include "voxdag/stored/attributes/validate_pages.hpp"
#include "voxdag/stored/attributes/value_encoder.hpp"

namespace voxdag {
namespace {

struct NamedValues {
  std::string name;
  std::vector<Value8> values;
};

/// Returns values that are hard in different ways.
std::vector<NamedValues> value_sets(std::size_t count) {
  std::mt19937 rng(3);
  const auto make = [&](const std::function<Value8(std::size_t)>& value) {
    std::vector<Value8> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = value(i);
    return values;
  };
  const auto byte = [&] { return static_cast<std::uint8_t>(rng() >> 24); };
  const auto grey = [](unsigned v) {
    const auto b = static_cast<std::uint8_t>(v);
    return Value8{b, b, b};
  };
  return {{"flat", make([](std::size_t) {
             return Value8{17, 200, 3};
           })},
          {"noise", make([&](std::size_t) {
             return Value8{byte(), byte(), byte()};
           })},
          {"grey noise",
           make([&](std::size_t) { return grey(100 + static_cast<unsigned>(rng() % 50)); })},
          {"ramp", make([&](std::size_t i) { return grey(static_cast<unsigned>(i)); })},
          {"two colours", make([&](std::size_t i) {
             return i / 7 % 2 ? Value8{250, 10, 0} : Value8{0, 60, 90};
           })},
          {"ends of the range",
           make([&](std::size_t) { return grey(static_cast<unsigned>(rng() % 2) * 255); })}};
}

double squared_error(Value8 a, Value8 b, const std::array<int, 3>& weights) {
  double sum = 0, all = 0;
  for (int c = 0; c < 3; ++c) {
    const double d = a[c] - b[c], w = weights[static_cast<std::size_t>(c)];
    sum += w * d * d;
    all += w;
  }
  return std::sqrt(sum / all);
}

ValuePages encode(const std::vector<Value8>& values, const ValueMetric& metric) {
  ValueEncoder encoder(values.size(), metric, nullptr);
  encoder.add(0, values);
  return encoder.finish();
}

TEST(EncodePage, EveryValueKeepsTheBound) {
  for (const NamedValues& set : value_sets(1000))
    for (const double bound : {0.0, 0.5, 1.0, 2.0, 5.0, 10.0, 40.0})
      for (const std::array<int, 3>& weights : {kColorWeights, std::array<int, 3>{1, 1, 1}}) {
        const ValuePages pages = encode(set.values, make_value_metric(weights, bound));
        ASSERT_NO_THROW(validate_value_pages(pages.view()));
        for (std::size_t i = 0; i < set.values.size(); ++i)
          ASSERT_LE(squared_error(read_value(pages.view(), i), set.values[i], weights),
                    bound + 1e-9)
              << set.name << ", bound " << bound << ", value " << i;
      }
}

TEST(EncodePage, ABoundOfZeroIsLossless) {
  for (const NamedValues& set : value_sets(700)) {
    const ValuePages pages = encode(set.values, make_value_metric(kColorWeights, 0));
    for (std::size_t i = 0; i < set.values.size(); ++i)
      ASSERT_EQ(read_value(pages.view(), i), set.values[i]) << set.name;
  }
}

TEST(EncodePage, FlatPagesAreAlmostFree) {
  const std::vector<Value8> flat(256 * 64, Value8{90, 91, 92});
  const ValuePages pages = encode(flat, make_value_metric(kColorWeights, 5));
  EXPECT_LE(8.0 * static_cast<double>(pages.view().bytes()) / static_cast<double>(flat.size()),
            0.2);
}

/// Returns the cost of a page: its bits, and the price of its errors.
double cost_of(const ValuePages& pages, const std::vector<Value8>& values,
               const ValueMetric& metric) {
  double errors = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    errors += metric.error(values[i], read_value(pages.view(), i));
  return 8 * static_cast<double>(pages.view().bytes() - pages.view().page_count() * 2 -
                                 pages.view().group_count() * 8) +
         errors * static_cast<double>(metric.price());
}

/// Compares with the best of all cuts of a page into blocks, found by dynamic programming. The
/// merges are greedy and use estimates.
TEST(EncodePage, ThePageCostsLittleMoreThanTheBestCut) {
  for (const NamedValues& set : value_sets(kPageValues))
    for (const double bound : {2.0, 8.0, 20.0}) {
      const ValueMetric metric = make_value_metric(kColorWeights, bound);
      const PagePrecision precision = choose_precision(metric);
      const BlockFitter fitter(std::span<const Value8, kPageValues>(set.values), metric, precision);
      std::vector<double> best{0};
      for (int end = kBlockUnit; end <= kPageValues; end += kBlockUnit) {
        double least = 1e30;
        ValueSums sums = ValueSums::of(set.values[static_cast<std::size_t>(end - 1)], metric);
        for (int begin = end - 2; begin >= 0; --begin) {
          sums += ValueSums::of(set.values[static_cast<std::size_t>(begin)], metric);
          if (begin % kBlockUnit == 0)
            least = std::min(least, best[static_cast<std::size_t>(begin / kBlockUnit)] +
                                        static_cast<double>(fitter.fit(begin, sums).cost));
        }
        best.push_back(least);
      }
      const double cost = cost_of(encode(set.values, metric), set.values, metric);
      EXPECT_GE(cost, best.back() - 0.01) << set.name << ", bound " << bound;
      // Pages end at whole words.
      EXPECT_LE(cost, 1.1 * best.back() + 64) << set.name << ", bound " << bound;
    }
}

/// Returns a normal in the xz plane.
Vec3f normal_at(double degrees) {
  const double radians = degrees * std::numbers::pi / 180;
  return {static_cast<float>(std::sin(radians)), 0, static_cast<float>(std::cos(radians))};
}

TEST(EncodePage, NormalsKeepTheirBoundEvenIfTheStoredVectorIsShort) {
  for (const double bound : {1.0, 4.0, 20.0, 50.0, 80.0, 120.0})
    for (double apart = 0; apart < 180; apart += 0.25) {
      // The mean of two such normals is shorter than they are.
      const Vec3f normals[] = {normal_at(apart), normal_at(-apart)};
      std::vector<Value8> values(256);
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = pack_normal(normals[i % 2]);
      const ValuePages pages = encode(values, make_normal_metric(bound));
      for (std::size_t i = 0; i < 2; ++i) {
        const Vec3d stored(unpack_normal(read_value(pages.view(), i)));
        const double cosine = std::clamp(dot(stored, Vec3d(normals[i])), -1.0, 1.0);
        ASSERT_LE(std::acos(cosine) * 180 / std::numbers::pi, bound + 0.05)
            << "bound " << bound << ", normals at " << apart << " degrees from z";
      }
    }
}

/// The last page of 300 values is filled up with copies, which are not values of cells.
TEST(EncodePage, ErrorsAreCountedForEveryGivenValueOnce) {
  for (const std::size_t count : {256, 300})
    for (const NamedValues& set : value_sets(count)) {
      ValueEncoder encoder(count, make_value_metric(kColorWeights, 12), nullptr);
      encoder.add(0, set.values);
      const ValuePages pages = encoder.finish();
      std::uint64_t squared = 0;
      double absolute = 0;
      for (std::size_t i = 0; i < count; ++i) {
        double sum = 0;
        for (int c = 0; c < 3; ++c) {
          const int d = int{read_value(pages.view(), i)[c]} - int{set.values[i][c]};
          squared += static_cast<std::uint64_t>(d * d);
          sum += d * d;
        }
        absolute += std::sqrt(sum);
      }
      EXPECT_EQ(encoder.errors().squared, squared) << set.name;
      EXPECT_NEAR(static_cast<double>(encoder.errors().absolute) / 256, absolute, 1) << set.name;
    }
}

TEST(ValueEncoder, CountsTheMemoryOfIncompletePages) {
  constexpr std::uint64_t kPages = 1000;
  MemoryBudget budget;
  {
    ValueEncoder encoder(kPages * kPageValues, make_value_metric(kColorWeights, 8), &budget);
    const std::vector<Value8> half(kPageValues / 2, Value8{1, 2, 3});
    for (std::uint64_t page = 0; page < kPages; ++page) encoder.add(page * kPageValues, half);
    EXPECT_GE(budget.used(), kPages * kPageValues * sizeof(Value8));
  }
  EXPECT_EQ(budget.used(), 0u);
}

TEST(ValueEncoder, TheOrderOfRangesAndThreadsDoNotMatter) {
  const std::vector<Value8> values = value_sets(20011)[2].values;
  const ValueMetric metric = make_value_metric(kColorWeights, 8);
  const ValuePages expected = encode(values, metric);
  std::mt19937 rng(9);
  std::vector<std::pair<std::size_t, std::size_t>> ranges;
  for (std::size_t begin = 0; begin < values.size();) {
    const std::size_t end = std::min<std::size_t>(begin + 1 + rng() % 700, values.size());
    ranges.emplace_back(begin, end);
    begin = end;
  }
  std::shuffle(ranges.begin(), ranges.end(), rng);
  ValueEncoder encoder(values.size(), metric, nullptr);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t i = t; i < ranges.size(); i += 4)
        encoder.add(ranges[i].first,
                    std::span(values).subspan(ranges[i].first, ranges[i].second - ranges[i].first));
    });
  for (std::thread& thread : threads) thread.join();
  const ValuePages pages = encoder.finish();
  EXPECT_EQ(pages.words, expected.words);
  EXPECT_EQ(pages.pages, expected.pages);
  EXPECT_EQ(pages.groups, expected.groups);
}

}  // namespace
}  // namespace voxdag
