#include "particles/parallel/work_memory.hpp"

#include <sys/mman.h>

#include <stdexcept>

namespace drumlin::particles {
namespace {

constexpr std::size_t boundary = 64;
// Pieces of at least two huge pages ask for these: a sweep goes through more small ones than a processor
// keeps the positions of.
constexpr std::size_t huge_page = std::size_t{1} << 21;
constexpr std::size_t least_piece = std::size_t{1} << 16;

}  // namespace

WorkMemory::Scope::Scope(WorkMemory* memory) : memory_(memory) {
  if (memory == nullptr) return;
  memory->scopes_.push_back({++memory->scopes_so_far_, memory->piece_, memory->used_});
}

WorkMemory::Scope::~Scope() {
  if (memory_ == nullptr) return;
  memory_->piece_ = memory_->scopes_.back().piece, memory_->used_ = memory_->scopes_.back().used;
  memory_->scopes_.pop_back();
}

std::size_t WorkMemory::bytes() const {
  std::size_t sum = 0;
  for (const Piece& piece : pieces_) sum += piece.size;
  return sum;
}

void WorkMemory::release() {
  if (!scopes_.empty()) return;
  next_piece_ = std::max(next_piece_, bytes());
  pieces_.clear();
}

void WorkMemory::Free::operator()(std::byte* bytes) const { ::operator delete[](bytes, align); }

void WorkMemory::add_piece(std::size_t bytes) {
  const bool large = bytes >= 2 * huge_page;
  const std::align_val_t align{large ? huge_page : boundary};
  auto* const piece = static_cast<std::byte*>(::operator new[](bytes, align));
  pieces_.push_back({std::unique_ptr<std::byte[], Free>(piece, Free{align}), bytes});
  // A wish: where the system does not know or grant it, nothing changes.
  if (large) (void)madvise(piece, bytes / huge_page * huge_page, MADV_HUGEPAGE);
}

void* WorkMemory::take(std::size_t bytes) {
  if (scopes_.empty()) throw std::logic_error("work memory is taken outside of a scope");
  bytes = (bytes + boundary - 1) / boundary * boundary;
  if (piece_ == 0 && used_ == 0 && pieces_.size() > 1) {  // nothing is taken: from now on one piece
    const std::size_t all = this->bytes();
    pieces_.clear();
    add_piece(std::max(all, bytes));
  }
  while (piece_ < pieces_.size() && used_ + bytes > pieces_[piece_].size) ++piece_, used_ = 0;
  if (piece_ == pieces_.size()) add_piece(std::max({bytes, least_piece, this->bytes() / 8, next_piece_}));
  next_piece_ = 0;
  void* const taken = pieces_[piece_].bytes.get() + used_;
  used_ += bytes;
  return taken;
}

}  // namespace drumlin::particles
