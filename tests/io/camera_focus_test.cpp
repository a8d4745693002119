#include "io/camera_focus.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <utility>

#include "scene_queries.hpp"

using namespace vrut;

namespace {

/// A square of side 2 about the origin, in the plane z = 0.
scene::Geometry square() {
    scene::Geometry square;
    square.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (const glm::dvec3& position : square.positions) square.bounds.add(position);
    return square;
}

glm::dmat4 moved_by(const glm::dvec3& offset, double scale = 1) {
    glm::dmat4 matrix(scale);
    matrix[3] = glm::dvec4(offset, 1);
    return matrix;
}

/// Squares at those places, and the camera as the first node.
struct Stage {
    explicit Stage(const glm::dmat4& camera_matrix = glm::dmat4(1)) {
        parts.geometries.push_back(square());
        add(scene::NodeType::camera, camera_matrix).data = scene::CameraData();
    }
    scene::Node& add(scene::NodeType type, const glm::dmat4& matrix, scene::Id parent = 0) {
        scene::SceneParts::PartNode& part = parts.nodes.emplace_back();
        part.node.id = static_cast<scene::Id>(parts.nodes.size());
        part.node.type = type;
        part.node.matrix = matrix;
        part.parent_id = parent;
        return part.node;
    }
    scene::Node& add_square(const glm::dmat4& matrix, scene::Id parent = 0) {
        scene::Node& node = add(scene::NodeType::geometry, matrix, parent);
        node.data = scene::GeometryData{0, scene::kNone};
        return node;
    }
    scene::CameraData& camera() { return std::get<scene::CameraData>(parts.nodes[0].node.data); }
    glm::dvec3 focus() {
        io::focus_on_what_is_seen(parts);
        return camera().focus;
    }

    scene::SceneParts parts;
};

bool near(const glm::dvec3& a, const glm::dvec3& b) { return glm::distance(a, b) < 1e-9; }

}  // namespace

TEST_CASE("a camera without a focus distance is focused on the first surface in the middle of its view") {
    Stage stage;
    stage.add_square(moved_by({0, 0, -9}));
    stage.add_square(moved_by({0.5, 0.2, -5}));
    stage.add_square(moved_by({1.5, 0, -3}));  // beside
    stage.add_square(moved_by({0, 0, 2}));     // behind
    CHECK(near(stage.focus(), {0, 0, -5}));
}

TEST_CASE("a focus distance is in the units of the camera's own space") {
    Stage stage(moved_by({0, 0, 7}, 2));
    stage.add(scene::NodeType::assembly, moved_by({0, 0, -3}, 0.5));
    stage.add_square(moved_by({0, 0, 4}), 2);  // at z = -1
    CHECK(near(stage.focus(), {0, 0, -4}));
}

TEST_CASE("of a view that meets nothing the scene's centre tells the depth, where it lies ahead") {
    Stage stage;
    stage.add_square(moved_by({-4, 0, -6}));
    stage.add_square(moved_by({4, 0, -8}));
    CHECK(near(stage.focus(), {0, 0, -7}));

    Stage turned_away;
    turned_away.add_square(moved_by({0, 0, 6}));
    CHECK(turned_away.focus() == glm::dvec3(0, 0, -1));

    Stage empty;
    CHECK(empty.focus() == glm::dvec3(0, 0, -1));
}

TEST_CASE("a focus distance of the file stays") {
    Stage stage;
    stage.add_square(moved_by({0, 0, -5}));
    stage.camera().focus = {0, 0, -2};
    CHECK(stage.focus() == glm::dvec3(0, 0, -2));
}

TEST_CASE("a camera is not focused on what is hidden, nor on what touches its lens") {
    Stage stage;
    stage.add_square(moved_by({0, 0, -3})).active = false;
    stage.add_square(moved_by({0, 0, -1e-6}));
    stage.add_square(moved_by({0, 0, -8}));
    CHECK(near(stage.focus(), {0, 0, -8}));
}

TEST_CASE("of very many cameras among very many parts the last ones are focused on the scene's centre") {
    constexpr int kMany = 5000;
    Stage stage;
    stage.add_square(moved_by({0, 0, -5}));
    for (int i = 0; i < kMany; ++i) {
        stage.add_square(moved_by({100, 0, -9}));
        stage.add(scene::NodeType::camera, glm::dmat4(1)).data = scene::CameraData();
    }
    CHECK(near(stage.focus(), {0, 0, -5}));
    CHECK(near(std::get<scene::CameraData>(stage.parts.nodes.back().node.data).focus, {0, 0, -7}));
}

TEST_CASE("what cannot be met changes no focus") {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const glm::dmat4& matrix : {moved_by({0, 0, -5}, 0), moved_by({0, 0, -kInfinity})}) {
        Stage stage;
        stage.add_square(matrix);
        CHECK(stage.focus() == glm::dvec3(0, 0, -1));
    }
    Stage flattened(moved_by({0, 0, 5}, 0));
    flattened.add_square(glm::dmat4(1));
    CHECK(flattened.focus() == glm::dvec3(0, 0, -1));
    Stage cycle;
    cycle.add_square(moved_by({0, 0, -5}), 2);  // its own parent
    CHECK(cycle.focus() == glm::dvec3(0, 0, -1));
}
