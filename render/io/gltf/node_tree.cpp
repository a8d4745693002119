#include "io/gltf/node_tree.hpp"

#include <cmath>

#include "io/gltf/instances.hpp"
#include "io/import_checks.hpp"
#include "io/vrut/tokenizer.hpp"

namespace vrut::io {

namespace {

glm::dmat4 matrix_in(const GltfJson& node) {
    glm::dmat4 matrix(1);
    const GltfJson* const numbers = numbers_in(node, "matrix", 16);
    for (std::size_t i = 0; i < 16 && numbers != nullptr; ++i)
        matrix[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = (*numbers)[i].get<double>();
    if (numbers != nullptr) return matrix;
    return matrix_of(vector_in<3>(node, "translation", glm::dvec3(0)),
                     vector_in<4>(node, "rotation", glm::dvec4(0, 0, 0, 1)),
                     vector_in<3>(node, "scale", glm::dvec3(1)));
}

/// Throws where it is not affine.
glm::dmat4 checked_matrix(const GltfJson& node, const std::string& name) {
    const auto reject = [&](const char* why) {
        throw ImportError("the matrix of node '" + excerpt(name) + "' " + why);
    };
    glm::dmat4 matrix = matrix_in(node);
    constexpr double kRounding = 1e-5;  // as programs write it that invert in single precision
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row)
            if (!is_coordinate(matrix[column][row]))
                reject("has an element that is not a number from -1e15 to 1e15");
        const double last = column == 3 ? 1 : 0;
        if (std::abs(matrix[column][3] - last) > kRounding)
            reject("is not affine: its last row is not 0 0 0 1");
        matrix[column][3] = last;
    }
    return matrix;
}

/// The nodes at the top of the scene that is shown.
const GltfJson& top_nodes(const GltfJson& document) {
    const GltfJson& scenes = array_in(document, "scenes");
    const std::uint32_t scene = index_in(document, "scene").value_or(0);
    if (scene >= scenes.size()) throw ImportError("it has no scene to show");
    return array_in(scenes[scene], "nodes");
}

}  // namespace

GltfNodeTree::GltfNodeTree(const GltfJson& document) {
    add_nodes(document);
    list_meshes(document);
}

void GltfNodeTree::add_nodes(const GltfJson& document) {
    const GltfJson& all = array_in(document, "nodes");
    std::vector<bool> reached(all.size());
    std::vector<std::pair<std::uint32_t, scene::Index>> open;  // nodes, and the places of their parents
    const auto open_each = [&](const GltfJson& list, const char* name, scene::Index parent) {
        for (std::size_t i = list.size(); i-- > 0;) {
            const std::uint32_t node = index_of(list[i], name);
            if (node >= all.size()) throw ImportError("there is no node " + std::to_string(node));
            if (reached[node]) throw ImportError("node " + std::to_string(node) + " has several parents");
            reached[node] = true;
            open.emplace_back(node, parent);
        }
    };
    open_each(top_nodes(document), "nodes", scene::kNone);
    while (!open.empty()) {
        const auto [index, parent] = open.back();
        open.pop_back();
        const GltfJson& json = all[index];
        const GltfJson& children = array_in(json, "children");
        std::string name = string_in(json, "name");
        if (name.empty()) name = "nodes[" + std::to_string(index) + "]";
        const glm::dmat4 matrix = checked_matrix(json, name);
        nodes_.push_back({json, std::move(name), parent, !children.empty(), matrix, index_in(json, "mesh")});
        open_each(children, "children", static_cast<scene::Index>(nodes_.size() - 1));
    }
}

void GltfNodeTree::list_meshes(const GltfJson& document) {
    std::vector<bool> listed(array_in(document, "meshes").size());
    std::vector<scene::Index> path;  // from the top down to the last node
    const auto leave_until = [&](scene::Index node) {
        for (; !path.empty() && path.back() != node; path.pop_back()) {
            const auto mesh = nodes_[static_cast<std::size_t>(path.back())].mesh;
            if (!mesh) continue;
            if (*mesh >= listed.size()) throw ImportError("there is no mesh " + std::to_string(*mesh));
            if (!listed[*mesh]) meshes_.push_back(*mesh);
            listed[*mesh] = true;
        }
    };
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        leave_until(nodes_[i].parent);
        path.push_back(static_cast<scene::Index>(i));
    }
    leave_until(scene::kNone);
}

}  // namespace vrut::io
