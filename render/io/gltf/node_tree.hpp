#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf/json.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// A node of the scene that a glTF file shows.
struct GltfTreeNode {
    const GltfJson& json;
    std::string name;     ///< `nodes[7]` where node 7 has none
    scene::Index parent;  ///< its place in GltfNodeTree::nodes(); kNone at the top
    bool has_children;
    glm::dmat4 matrix;                  ///< parent from node
    std::optional<std::uint32_t> mesh;  ///< which is there
};

/// The nodes of the scene that a glTF file shows. They are known to form a tree.
class GltfNodeTree {
public:
    /// The document must outlive this object. Throws ImportError.
    explicit GltfNodeTree(const GltfJson& document);

    /// Each before its children, as they stand in the file.
    const std::vector<GltfTreeNode>& nodes() const { return nodes_; }
    /// The meshes that they show, each once: those of a node's children before its own.
    const std::vector<std::uint32_t>& meshes() const { return meshes_; }

private:
    void add_nodes(const GltfJson& document);
    void list_meshes(const GltfJson& document);

    std::vector<GltfTreeNode> nodes_;
    std::vector<std::uint32_t> meshes_;
};

}  // namespace vrut::io
