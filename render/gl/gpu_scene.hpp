#pragma once

#include <array>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "gl/handles.hpp"
#include "plan/frame_plan.hpp"
#include "scene/scene.hpp"

namespace vrut::gl {

/// A geometry on the GPU. Positions are float, relative to `origin` (in the geometry's own space), so that a
/// scene far from the world's origin keeps its precision.
struct GpuGeometry {
    GlBuffer vertices, indices;
    GlBuffer texcoords;  ///< for each vertex, if the geometry has any; moved by whole numbers to lie around 0
    GlVertexArray vertex_array;
    GLsizei index_count = 0;
    glm::dvec3 origin{0};
};

/// The edges of a geometry's triangles, as lines between its vertices: each once, however many triangles
/// share it, and though their corners have normals of their own.
struct GpuEdges {
    GlBuffer indices;
    GlVertexArray vertex_array;  ///< with the geometry's vertices
    GLsizei index_count = 0;
};

/// A geometry's triangles in another order (plan::TriangleOrder). It never changes: a draw that the GPU has
/// not done yet keeps its triangles.
struct GpuTriangles {
    scene::Index geometry = scene::kNone;
    std::shared_ptr<const std::vector<unsigned>> order;
    GlBuffer indices;
    GlVertexArray vertex_array;  ///< with the geometry's vertices
    GLsizei index_count = 0;
};

/// The geometries and textures of a scene, each uploaded when it is first drawn.
class GpuScene {
public:
    explicit GpuScene(std::shared_ptr<const scene::Scene> scene);
    const std::shared_ptr<const scene::Scene>& scene() const { return scene_; }
    /// What a view of it shows, in the picture or beside it. Throws OutOfMemory, as all below.
    void upload_shown(const plan::View& view);
    const GpuGeometry& geometry(scene::Index index);
    /// Of an item: its level's, if it has one.
    const GpuGeometry& geometry(const plan::DrawItem& item);
    /// Whether that is there already.
    bool is_resident(const plan::DrawItem& item) const;
    const GpuEdges& edges(scene::Index index);
    /// Its triangles in an item's order, which is not null. Items of the same geometry and order share them.
    /// Beyond kMaxSortedBytes those that have not been asked for the longest are given back; a result is
    /// valid until the next call.
    const GpuTriangles& sorted_triangles(const plan::DrawItem& item);
    static constexpr std::size_t kMaxSortedBytes = std::size_t{32} << 20;
    const GlTexture& texture(scene::Index index);
    /// Of the six textures (upload_cube_map()).
    const GlTexture& cube_map(const std::array<scene::Index, 6>& textures);
    /// Geometries, their levels, orders and edges, textures and cube maps uploaded so far.
    int uploads() const { return uploads_; }

private:
    std::shared_ptr<const scene::Scene> scene_;
    std::vector<GpuGeometry> geometries_;
    std::map<std::pair<scene::Index, int>, GpuGeometry> levels_;  // by geometry and the level's number
    std::vector<std::optional<GpuEdges>> edges_;  // after the geometries, whose vertices they use
    struct ByOrder {
        bool operator()(const GpuTriangles* a, const GpuTriangles* b) const;
    };
    const std::vector<glm::uvec3>& uploaded_triangles(scene::Index geometry);
    GpuTriangles upload_sorted(const plan::DrawItem& item);

    std::list<GpuTriangles> sorted_triangles_;  // the latest used first
    std::map<const GpuTriangles*, std::list<GpuTriangles>::iterator, ByOrder> sorted_by_order_;
    std::size_t sorted_bytes_ = 0;
    std::map<scene::Index, std::vector<glm::uvec3>> uploaded_triangles_;  // of those with sorted triangles
    std::vector<GlTexture> textures_;
    std::map<std::array<scene::Index, 6>, GlTexture> cube_maps_;
    int uploads_ = 0;
};

}  // namespace vrut::gl
