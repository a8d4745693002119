#include "scene/camera.hpp"

#include <algorithm>
#include <cmath>

#include "math/frustum.hpp"

namespace vrut::scene {

namespace {

constexpr double kSmallestNearToFar = 1e-6;
constexpr double kSmallestNearToFocus = 1e-3;
constexpr double kMargin = 1e-3;  // keeps what touches the planes from being clipped by rounding
bool all_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

double focus_distance(const Camera& camera) { return glm::distance(camera.eye, camera.focus); }
glm::dvec3 view_direction(const Camera& camera) { return glm::normalize(camera.focus - camera.eye); }
glm::dvec3 right_direction(const Camera& camera) {
    return glm::normalize(glm::cross(view_direction(camera), camera.up));
}

bool is_valid_pose(const Camera& camera, double scene_radius) {
    if (!all_finite(camera.eye) || !all_finite(camera.focus) || !all_finite(camera.up) ||
        !all_finite(camera.center))
        return false;
    const double distance = focus_distance(camera);
    if (!std::isfinite(distance) || distance == 0 || distance < 1e-9 * scene_radius) return false;
    const double length = glm::length(camera.up);
    if (!std::isfinite(length) || length == 0) return false;
    return glm::length(glm::cross(view_direction(camera), camera.up / length)) > 1e-9;
}

Camera with_orthogonal_up(Camera camera) {
    const glm::dvec3 view = view_direction(camera);
    const glm::dvec3 up = glm::normalize(camera.up);
    // Left as it is where it is right already, so that reading a pose and writing it back changes nothing.
    if (std::abs(glm::dot(view, up)) < 1e-15 && std::abs(glm::length(camera.up) - 1) < 1e-15) return camera;
    // Two products stay orthogonal where up lies close to the view and a difference would not.
    camera.up = glm::normalize(glm::cross(glm::cross(view, up), view));
    return camera;
}

Camera with_roll_of(const Camera& before, Camera pose) {
    const bool level = std::abs(right_direction(before).y) < 1e-9;
    const glm::dvec3 view = pose.focus - pose.eye;
    const bool vertical_view = glm::length(glm::dvec2(view.x, view.z)) <= 1e-9 * glm::length(view);
    if (level && !vertical_view) pose.up = before.up.y < 0 ? -kVertical : kVertical;
    return pose;
}

ClipRange fit_clip_range(const Camera& camera, const math::Bounds& bounds) {
    const double distance = focus_distance(camera);
    ClipRange range{distance * 0.01, distance * 10};
    if (bounds.empty()) return range;
    const glm::dvec3 view = view_direction(camera);
    double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    for (const glm::dvec3& corner : math::corners(bounds)) {
        const double depth = glm::dot(corner - camera.eye, view);
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
    }
    if (farthest <= 0) return range;  // everything is behind the eye
    range.far = farthest * (1 + kMargin);
    // Something very far away must not push the near plane through what is looked at.
    const double smallest = std::min(range.far * kSmallestNearToFar, distance * kSmallestNearToFocus);
    range.near = std::max(nearest * (1 - kMargin), smallest);
    return range;
}

glm::dmat4 view_from_world(const Camera& camera) {
    const glm::dvec3 back = -view_direction(camera);
    const glm::dvec3 right = right_direction(camera);
    const glm::dvec3 up = glm::cross(back, right);
    glm::dmat4 matrix(1);
    for (int i = 0; i < 3; ++i) {
        matrix[i][0] = right[i];
        matrix[i][1] = up[i];
        matrix[i][2] = back[i];
    }
    matrix[3] = {-glm::dot(right, camera.eye), -glm::dot(up, camera.eye), -glm::dot(back, camera.eye), 1};
    return matrix;
}

math::Projection projection_of(const Camera& camera, double aspect) {
    return math::symmetric_projection(camera.fov * kRadiansPerDegree, aspect);
}

glm::dvec3 direction_through(const Camera& camera, double aspect, const glm::dvec2& point) {
    const glm::dvec2 at = projection_of(camera, aspect).at({point.x, -point.y});
    const glm::dvec3 view = view_direction(camera), right = right_direction(camera);
    return glm::normalize(view + right * at.x + glm::cross(right, view) * at.y);
}

std::optional<Camera> camera_at(const PlacedScene& placed, Index camera_node) {
    const auto place = static_cast<std::size_t>(camera_node);
    const auto& data = std::get<CameraData>(placed.scene->nodes()[place].data);
    const glm::dmat4& world = placed.world[place];
    Camera camera;
    camera.eye = glm::dvec3(world * glm::dvec4(data.eye, 1));
    camera.focus = camera.center = glm::dvec3(world * glm::dvec4(data.focus, 1));
    camera.up = glm::dvec3(world * glm::dvec4(data.up, 0));
    camera.fov = data.fov;
    if (!is_valid_pose(camera, placed.bounds.radius())) return std::nullopt;
    return with_orthogonal_up(camera);
}

std::vector<Seat> seats(const PlacedScene& placed) {
    std::vector<Seat> found;
    for (const Index node : placed.scene->looking_cameras()) {
        const double radius =
            std::get<CameraData>(placed.scene->nodes()[static_cast<std::size_t>(node)].data).look_radius;
        if (const std::optional<Camera> camera = camera_at(placed, node))
            found.push_back({camera->eye, radius});
    }
    return found;
}

bool looks_around_from(const PlacedScene& placed, const glm::dvec3& eye) {
    return std::ranges::any_of(seats(placed),
                               [&](const Seat& seat) { return glm::distance(seat.eye, eye) <= seat.radius; });
}

namespace {

/// The camera node with the lowest id, or kNone.
Index lowest_camera_node(const Scene& scene) {
    for (const auto& [id, index] : scene.index_by_id())
        if (scene.nodes()[static_cast<std::size_t>(index)].type == NodeType::camera) return index;
    return kNone;
}

/// Presentation does not count. True if nothing else can be drawn, too.
bool sees_something(const PlacedScene& placed, const Camera& camera) {
    constexpr double kAspect = 16.0 / 9;  // a tablet's, lying
    const math::Frustum frustum = math::frustum_of(projection_of(camera, kAspect));
    const glm::dmat4 view = view_from_world(camera);
    const Scene& scene = *placed.scene;
    bool nothing = true;
    for (const Index node : placed.drawable) {
        if (scene.is_presentation(node)) continue;
        nothing = false;
        const auto at = static_cast<std::size_t>(node);
        const Index geometry = std::get<GeometryData>(scene.nodes()[at].data).geometry;
        if (!math::is_outside(frustum, view * placed.world[at],
                              scene.geometries()[static_cast<std::size_t>(geometry)].bounds))
            return true;
    }
    return nothing;
}

}  // namespace

Index first_camera_node(const PlacedScene& placed) {
    const Index node = lowest_camera_node(*placed.scene);
    if (node == kNone) return kNone;
    const std::optional<Camera> camera = camera_at(placed, node);
    return camera && sees_something(placed, *camera) ? node : kNone;
}

std::optional<std::string> why_not_first_camera(const PlacedScene& placed) {
    const Index node = lowest_camera_node(*placed.scene);
    if (node == kNone || first_camera_node(placed) == node) return std::nullopt;
    return "the first view shows the whole scene: camera node " +
           std::to_string(placed.scene->nodes()[static_cast<std::size_t>(node)].id) + " sees nothing of it";
}

}  // namespace vrut::scene
