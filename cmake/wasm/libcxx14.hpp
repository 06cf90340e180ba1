// Defines the parts of C++20 that libc++ 14 lacks, the standard library of Debian 12's emscripten.
// A build for browsers includes this file before every source.
#pragma once
#ifdef __cplusplus
#include <atomic>
#include <bit>
#include <charconv>

namespace std {

#ifndef __cpp_lib_atomic_ref
template <class T>
struct atomic_ref {
  explicit atomic_ref(T& value) : value_(&value) {}

  T load(memory_order order = memory_order_seq_cst) const {
    return __atomic_load_n(value_, int(order));
  }
  void store(T value, memory_order order = memory_order_seq_cst) const {
    __atomic_store_n(value_, value, int(order));
  }
  T exchange(T value, memory_order order = memory_order_seq_cst) const {
    return __atomic_exchange_n(value_, value, int(order));
  }
  bool compare_exchange_strong(T& expected, T value,
                               memory_order order = memory_order_seq_cst) const {
    return __atomic_compare_exchange_n(value_, &expected, value, false, int(order), failure(order));
  }
  bool compare_exchange_strong(T& expected, T value, memory_order order,
                               memory_order failed) const {
    return __atomic_compare_exchange_n(value_, &expected, value, false, int(order), int(failed));
  }
  T fetch_add(T value, memory_order order = memory_order_seq_cst) const {
    return __atomic_fetch_add(value_, value, int(order));
  }
  T fetch_or(T value, memory_order order = memory_order_seq_cst) const {
    return __atomic_fetch_or(value_, value, int(order));
  }
  T fetch_xor(T value, memory_order order = memory_order_seq_cst) const {
    return __atomic_fetch_xor(value_, value, int(order));
  }

 private:
  static int failure(memory_order order) {
    return order == memory_order_release   ? __ATOMIC_RELAXED
           : order == memory_order_acq_rel ? __ATOMIC_ACQUIRE
                                           : int(order);
  }
  T* value_;
};
#endif

#ifndef __cpp_lib_bit_cast
template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}
#endif

// libcxx14.cpp defines the conversions of numbers with a fraction.
to_chars_result to_chars(char* first, char* last, double value);
to_chars_result to_chars(char* first, char* last, float value);
to_chars_result to_chars(char* first, char* last, double value, chars_format general, int digits);
from_chars_result from_chars(const char* first, const char* last, double& value);
from_chars_result from_chars(const char* first, const char* last, float& value);

}  // namespace std
#endif
