#pragma once
// Sums at the nodes of a map, held where there are any: grains seldom fill the box around them.
#include <cstddef>
#include <vector>

#include "coupling/core/results/kernel_nodes.hpp"

namespace drumlin::particles {

/// One sum per node of a grid, zero where nothing was added. Memory: of the square tiles that somebody wrote
/// to.
template <class Node>
class NodeTiles {
 public:
  NodeTiles() = default;
  explicit NodeTiles(const MapGrid& grid)
      : columns_(grid.columns),
        rows_(grid.rows),
        across_(tiles_along(grid.columns)),
        tiles_(across_ * tiles_along(grid.rows)) {}

  /// For writing: makes the tile.
  Node& operator[](MapPlace at) {
    std::vector<Node>& tile = tiles_[tile_of(at.column, at.row)];
    if (tile.empty()) tile.resize(nodes_per_tile);
    return tile[place_in_tile(at.column, at.row)];
  }
  const Node& operator()(std::size_t column, std::size_t row) const {
    static const Node zero{};
    const std::vector<Node>& tile = tiles_[tile_of(column, row)];
    return tile.empty() ? zero : tile[place_in_tile(column, row)];
  }
  /// Nodes counted row after row.
  const Node& operator[](std::size_t node) const { return (*this)(node % columns_, node / columns_); }

  std::size_t size() const { return columns_ * rows_; }

  static std::size_t tiles_along(std::size_t nodes) { return (nodes + edge - 1) / edge; }
  /// Nodes along a side of a tile.
  static constexpr std::size_t edge = 16;
  static constexpr std::size_t nodes_per_tile = edge * edge;
  std::size_t tiles() const { return tiles_.size(); }
  /// Nodes of one tile, row after row, of a row of tiles after the one below it; empty where nobody wrote.
  const std::vector<Node>& tile(std::size_t t) const { return tiles_[t]; }
  std::size_t bytes() const {
    std::size_t bytes = tiles_.capacity() * sizeof(tiles_.front());
    for (const std::vector<Node>& tile : tiles_) bytes += tile.capacity() * sizeof(Node);
    return bytes;
  }

 private:
  std::size_t tile_of(std::size_t column, std::size_t row) const {
    return row / edge * across_ + column / edge;
  }
  static std::size_t place_in_tile(std::size_t column, std::size_t row) {
    return row % edge * edge + column % edge;
  }

  std::size_t columns_ = 0, rows_ = 0, across_ = 0;
  std::vector<std::vector<Node>> tiles_;
};

}  // namespace drumlin::particles
