#include "plan/occlusion_culling.hpp"

#include <algorithm>
#include <cmath>

namespace vrut::plan {

namespace {

/// Of boxes, of the distance from the eye, or in pixels there. The larger one counts.
constexpr double kDepthMargin = 1e-4, kMarginPixels = 1.0 / 8;
/// The least depth of a box, of the distance of its farthest point. On a face that begins nearer,
/// interpolated depth is rounded by more than the margin.
constexpr double kLeastNearest = 1.0 / 64;

/// A query takes the time of so many triangles, and of one more for so many pixels of its box. Measured on
/// llvmpipe.
constexpr double kTrianglesOfQuery = 250, kPixelsOfTriangle = 45;
constexpr double kMostShareOfQuery = 0.5;     ///< of its item's time
constexpr double kLeastShareOccluded = 0.05;  ///< of an image's triangles, for which waiting for results pays

/// From image to image, of the distance between eye and scene. Beyond that, more is drawn late than is saved:
/// on a car of 5 million triangles a third is saved at 0.17, a seventh at 0.7, and at 1.7 a third is lost.
constexpr double kMostMove = 0.75;

const scene::Geometry& geometry_of(const DrawItem& item, const View& view) {
    return view.scene->scene->geometries()[static_cast<std::size_t>(item.geometry)];
}

/// Orthonormal and right-handed: along the longest edge, and in its plane with another one if there is one.
glm::dmat3 axes_along(const glm::dmat3& edges) {
    const auto longer = [](const glm::dvec3& a, const glm::dvec3& b) {
        return glm::dot(a, a) < glm::dot(b, b) ? b : a;
    };
    const glm::dvec3 longest = longer(longer(edges[0], edges[1]), edges[2]);
    const double length = glm::length(longest);
    if (length == 0) return glm::dmat3(1);
    const glm::dvec3 u = longest / length;
    const auto beside = [&](const glm::dvec3& edge) { return edge - glm::dot(edge, u) * u; };
    glm::dvec3 v = longer(longer(beside(edges[0]), beside(edges[1])), beside(edges[2]));
    if (!(glm::length(v) > 1e-9 * length)) {
        const bool along_x = std::abs(u.x) > 0.5;
        v = beside({along_x ? 0 : 1, along_x ? 1 : 0, 0});
    }
    v = glm::normalize(v);
    return {u, v, glm::cross(u, v)};
}

/// Returns true if a query takes little time beside the item's triangles.
bool is_candidate(const DrawItem& item, const View& view, const glm::dmat4& clip_from_view) {
    const double most = kMostShareOfQuery * static_cast<double>(triangle_count(item, *view.scene->scene));
    if (most < kTrianglesOfQuery) return false;
    const glm::dvec2 size(math::pixel_box(geometry_of(item, view).bounds,
                                          clip_from_view * item.view_from_node, {view.width, view.height})
                              .size());
    return kTrianglesOfQuery + size.x * size.y / kPixelsOfTriangle <= most;
}

}  // namespace

void OcclusionHistory::begin_image(const glm::dvec3& eye, double most_move) {
    ++image_;
    if (glm::distance(eye, eye_) > most_move) nodes_.assign(nodes_.size(), {.next = image_ + 1});
    eye_ = eye;
}

void OcclusionHistory::set_occluded(scene::Index node, bool occluded) {
    Node& known = nodes_[static_cast<std::size_t>(node)];
    known.interval = known.occluded == occluded ? std::min(2 * known.interval, kLongestInterval) : 2;
    known.occluded = occluded;
    // Nodes that were first queried together are spread over the images.
    const std::uint32_t half = known.interval / 2;
    known.next = image_ + half + static_cast<std::uint32_t>(node) % (half + 1);
}

std::optional<OcclusionBox> occlusion_box(const DrawItem& item, const View& view) {
    const math::Bounds& bounds = geometry_of(item, view).bounds;
    const glm::dvec3 half = bounds.half_extent(),
                     center(item.view_from_node * glm::dvec4(bounds.center(), 1));
    const glm::dmat3 matrix(item.view_from_node);
    const glm::dmat3 edges(matrix[0] * half.x, matrix[1] * half.y, matrix[2] * half.z);
    const glm::dmat3 axes = axes_along(edges);
    glm::dvec3 reach(0);
    for (int axis = 0; axis < 3; ++axis)
        for (int edge = 0; edge < 3; ++edge) reach[axis] += std::abs(glm::dot(axes[axis], edges[edge]));
    const double farthest = glm::length(center) + glm::length(reach);
    const double pixel = projection_of(view).width() / view.width;  // at distance 1
    reach += farthest * std::max(kDepthMargin, kMarginPixels * pixel);
    const double nearest = -center.z - glm::dot(glm::abs(glm::transpose(axes)[2]), reach);
    if (!(nearest > std::max(2 * near_distance(view), kLeastNearest * farthest))) return {};
    OcclusionBox box{item.node};
    for (int axis = 0; axis < 3; ++axis) box.view_from_box[axis] = glm::dvec4(axes[axis] * reach[axis], 0);
    box.view_from_box[3] = glm::dvec4(center, 1);
    return box;
}

bool culls_occluded(const View& view) {
    const scene::Style style = style_of(view);
    return view.methods.culling == Methods::Culling::occlusion && style.faces && !style.edges;
}

OcclusionPlan plan_occlusion(std::span<const DrawItem> opaque, const View& view,
                             const glm::dmat4& clip_from_view, OcclusionHistory& history) {
    struct Candidate {
        std::size_t item;
        OcclusionBox box;
    };
    const scene::Scene& scene = *view.scene->scene;
    const math::Bounds& bounds = view.scene->bounds;
    history.begin_image(view.camera.eye, kMostMove * std::max(glm::distance(view.camera.eye, bounds.center()),
                                                              bounds.radius()));
    std::vector<Candidate> occluded, others;
    std::size_t triangles = 0, occluded_triangles = 0;
    for (std::size_t i = 0; i < opaque.size(); ++i) {
        const DrawItem& item = opaque[i];
        const std::size_t own_triangles = triangle_count(item, scene);
        triangles += own_triangles;
        const bool expected = history.is_occluded(item.node);
        if (!expected && !history.is_query_due(item.node)) continue;
        if (!is_candidate(item, view, clip_from_view)) continue;
        const std::optional<OcclusionBox> box = occlusion_box(item, view);
        if (!box) continue;
        if (history.is_query_due(item.node)) others.push_back({i, *box});
        if (!expected) continue;
        occluded.push_back({i, *box});
        occluded_triangles += own_triangles;
    }
    OcclusionPlan plan;
    const bool pays =
        static_cast<double>(occluded_triangles) > kLeastShareOccluded * static_cast<double>(triangles);
    if (pays) {
        std::size_t next = 0;
        for (std::size_t i = 0; i < opaque.size(); ++i) {
            const bool culled = next < occluded.size() && occluded[next].item == i;
            (culled ? plan.culled : plan.drawn).push_back(opaque[i]);
            if (culled) plan.boxes.push_back(occluded[next++].box);
        }
    }
    for (const Candidate& candidate : others)
        if (!pays || !history.is_occluded(candidate.box.node)) plan.boxes.push_back(candidate.box);
    return plan;
}

}  // namespace vrut::plan
