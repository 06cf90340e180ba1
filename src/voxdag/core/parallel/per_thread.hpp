#pragma once
/// A value of its own for each thread that works on a loop.
#ifndef VOXDAG_OWN_THREADS
#include <tbb/enumerable_thread_specific.h>
#else
#include <functional>
#include <list>
#include <mutex>
#include <utility>

#include "voxdag/core/parallel/thread_pool.hpp"
#endif

namespace voxdag {

#ifndef VOXDAG_OWN_THREADS

/// local() returns the value of the calling thread, which a function given to the constructor makes
/// when the thread asks first; by default T(). After the loop, begin() and end() list all values,
/// in unspecified order.
template <class T>
using PerThread = tbb::enumerable_thread_specific<T>;

#else

template <class T>
class PerThread {
 public:
  PerThread() : make_([] { return T(); }) {}
  template <class Make>
  explicit PerThread(Make make) : make_(std::move(make)) {}

  T& local() {
    const std::size_t thread = thread_number();
    const std::lock_guard lock(mutex_);
    for (Value& value : values_)
      if (value.thread == thread) return value.value;
    return values_.emplace_back(thread, make_).value;
  }

  auto begin() { return Iterator{values_.begin()}; }
  auto end() { return Iterator{values_.end()}; }

 private:
  struct Value {
    Value(std::size_t thread_in, const std::function<T()>& make)
        : thread(thread_in), value(make()) {}
    std::size_t thread;
    T value;
  };
  struct Iterator {
    typename std::list<Value>::iterator at;
    T& operator*() const { return at->value; }
    Iterator& operator++() {
      ++at;
      return *this;
    }
    bool operator==(const Iterator&) const = default;
  };

  std::function<T()> make_;
  std::mutex mutex_;
  std::list<Value> values_;
};

#endif

}  // namespace voxdag
