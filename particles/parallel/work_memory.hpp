#pragma once
// Memory that the phases of a step use one after the other: a stack of scopes, and arrays that live in them.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace drumlin::particles {

/// A stack of scopes. What is taken within a scope ends with it; its bytes go to the next one. Of one thread.
class WorkMemory {
 public:
  /// The time from its construction to its end; scopes stand within one another. Without memory it does
  /// nothing.
  class Scope {
   public:
    explicit Scope(WorkMemory* memory);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    WorkMemory* memory_;
  };

  /// Bytes of the innermost scope, not set, on a boundary of 64. Throws std::logic_error if no scope is open.
  void* take(std::size_t bytes);
  /// The innermost scope, by a number that no other one has had; 0: none is open.
  std::uint64_t scope() const { return scopes_.empty() ? 0 : scopes_.back().number; }
  bool is_open(std::uint64_t scope) const {
    return std::any_of(scopes_.rbegin(), scopes_.rend(), [=](const Mark& m) { return m.number == scope; });
  }
  /// What it holds, used or not.
  std::size_t bytes() const;
  /// Gives everything back to the system until it is needed again; does nothing within a scope.
  void release();

 private:
  struct Free {
    std::align_val_t align{64};
    void operator()(std::byte* bytes) const;
  };
  struct Piece {
    std::unique_ptr<std::byte[], Free> bytes;
    std::size_t size = 0;
  };
  struct Mark {
    std::uint64_t number = 0;
    std::size_t piece = 0, used = 0;  // where the scope begins
  };
  void add_piece(std::size_t bytes);

  std::vector<Piece> pieces_;
  std::vector<Mark> scopes_;
  std::size_t piece_ = 0, used_ = 0;  // what is taken: the pieces before this one, and so much of it
  std::uint64_t scopes_so_far_ = 0;
  std::size_t next_piece_ = 0;  // bytes, at least: what was given back
};

/// An array whose entries are not set when it gets longer. In a WorkMemory it is empty again when the scope
/// has ended in which it was made; on its own it keeps what it has.
template <class T>
class WorkArray {
  static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= 64);

 public:
  WorkArray() = default;
  WorkArray(const WorkArray&) = delete;
  WorkArray& operator=(const WorkArray&) = delete;
  WorkArray(WorkArray&&) noexcept = default;
  WorkArray& operator=(WorkArray&&) noexcept = default;

  /// Lets it live in a memory from now on, without entries; none: on its own.
  void use(WorkMemory* memory) {
    if (memory == memory_) return;
    *this = WorkArray();
    memory_ = memory;
  }
  /// Becomes `count` long; what it held may be lost.
  void resize_uninitialized(std::size_t count) {
    if (count > capacity()) move_to(count, 0);
    size_ = count;
  }
  /// Becomes `count` long and keeps the entries that it has.
  void resize(std::size_t count) {
    const std::size_t kept = size();
    if (count > capacity()) move_to(count + (kept > 0 ? count / 16 : 0), kept);
    size_ = count;
  }
  void assign(std::size_t count, const T& value) {
    resize_uninitialized(count);
    std::fill(data_, data_ + count, value);
  }

  std::size_t size() const { return lives() ? size_ : 0; }
  std::size_t capacity() const { return lives() ? capacity_ : 0; }
  bool empty() const { return size() == 0; }
  T* data() { return data_; }
  const T* data() const { return data_; }
  T& operator[](std::size_t k) { return data_[k]; }
  const T& operator[](std::size_t k) const { return data_[k]; }
  T* begin() { return data_; }
  T* end() { return data_ + size(); }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size(); }

 private:
  struct Free {
    void operator()(T* entries) const { ::operator delete (entries, std::align_val_t{64}); }
  };
  bool lives() const { return memory_ == nullptr || memory_->is_open(scope_); }
  void move_to(std::size_t capacity, std::size_t kept) {
    const std::size_t bytes = capacity * sizeof(T);
    if (memory_ != nullptr) {
      T* const to = static_cast<T*>(memory_->take(bytes));
      if (kept > 0) std::memcpy(to, data_, kept * sizeof(T));
      data_ = to;
      scope_ = memory_->scope();
    } else {
      if (kept == 0) own_.reset();
      std::unique_ptr<T, Free> to(static_cast<T*>(::operator new (bytes + bytes / 16, std::align_val_t{64})));
      if (kept > 0) std::memcpy(to.get(), data_, kept * sizeof(T));
      own_ = std::move(to);
      data_ = own_.get();
      capacity += capacity / 16;
    }
    capacity_ = capacity;
  }

  WorkMemory* memory_ = nullptr;
  std::unique_ptr<T, Free> own_;
  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
  std::uint64_t scope_ = 0;
};

template <class T>
std::size_t bytes_of(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

/// Gives back what a vector holds. To assign {} to it would keep that for later.
template <class T>
void free_memory_of(std::vector<T>& values) {
  std::vector<T>().swap(values);
}

/// Makes a vector `count` long, which holds little more than that: one that grows by itself may hold twice as
/// much. What it held may be lost.
template <class T>
void resize_closely(std::vector<T>& values, std::size_t count) {
  if (count > values.capacity()) {
    free_memory_of(values);
    values.reserve(count + count / 16);
  }
  values.resize(count);
}

}  // namespace drumlin::particles
