#include "coupling/core/documents/key_writer.hpp"

namespace drumlin {

KeyWriter::KeyWriter() { root_.value = Node::Table{}; }

void KeyWriter::add(const std::string& key, Node node) {
  std::get<Node::Table>(root_.value).push_back({key, std::move(node)});
}

}  // namespace drumlin
