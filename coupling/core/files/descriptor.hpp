#pragma once
// An open file of the system that closes itself.
#include <string_view>
#include <utility>

namespace drumlin {

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { (void)close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    other.number_ = std::exchange(number_, other.number_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }  ///< negative: it could not be opened
  /// Writes all of it; false where the system does not take it (errno).
  bool write(std::string_view bytes) const;
  /// Whether the system had nothing to say of what was written.
  bool close();

 private:
  int number_;
};

}  // namespace drumlin
