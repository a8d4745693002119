#pragma once

#include <array>
#include <chrono>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "gl/handles.hpp"
#include "gl/preparation.hpp"
#include "gl/upload.hpp"
#include "plan/draw_groups.hpp"
#include "plan/frame_plan.hpp"
#include "scene/scene.hpp"

namespace vrut::gl {

/// The attributes of an instance, which surfaces of an instanced program (is_instanced()) have in the place
/// of uniforms.
struct GpuInstance {
    glm::mat4 view_from_local;
    glm::mat3x4 normal_matrix;
    glm::vec4 base_sides;            ///< w: 1 if two-sided, else 0
    glm::vec4 diffuse_reflectivity;  ///< w: the reflectivity
    glm::vec4 specular_shininess;    ///< w: the shininess
    glm::vec4 clip_plane;            ///< in local space
};
/// The binding of a vertex array to whose buffer a draw has to bind its instances.
inline constexpr GLuint kInstanceBinding = 2;

/// The buffers of a large geometry, or of many small ones, which one draw call can draw then.
struct GeometryBuffers {
    GlBuffer vertices, indices;
    /// For each vertex, if the geometries have any; moved by whole numbers to lie around 0.
    GlBuffer texcoords;
    GlBuffer low_positions;  ///< what float leaves of positions that are double-single
    GlVertexArray vertex_array;
    bool shared = false;
};

/// A geometry on the GPU. Positions are float, relative to `origin` (in the geometry's own space), so that a
/// scene far from the world's origin keeps its precision.
struct GpuGeometry {
    std::shared_ptr<const GeometryBuffers> buffers;
    GLuint first_index = 0;
    GLint first_vertex = 0;  ///< what the indices count from
    GLsizei index_count = 0;
    glm::dvec3 origin{0};

    /// Scene::needs_double_single()
    bool is_double_single() const { return bool(buffers->low_positions); }
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

/// The geometries and textures of a scene on the GPU. Their data is made on other threads (Preparation), when
/// it is first asked for, and copied in steps.
class GpuScene {
public:
    explicit GpuScene(std::shared_ptr<const scene::Scene> scene);
    const std::shared_ptr<const scene::Scene>& scene() const { return scene_; }

    // Each asks for what is not resident, and returns true if all is resident.
    /// What a view of it shows, in the picture or beside it.
    bool request_shown(const plan::View& view);
    /// What an item's faces take; `levels` hold its level, if it has one.
    bool request(const plan::DrawItem& item, const std::shared_ptr<const mesh::DetailLevels>& levels);
    bool request(scene::Index geometry, const mesh::DetailLevel& level,
                 const std::shared_ptr<const mesh::DetailLevels>& levels, Need need);
    /// What an item's edges take.
    bool request_edges(const plan::DrawItem& item, Need need);
    bool request_background(const plan::View& view);

    /// Copies what is made until `budget` is spent. Throws OutOfMemory for what is needed now, as the lookups
    /// below do; what is needed soon is not asked for again as such.
    void upload(plan::DrawBudget& budget);
    /// Until there is something to copy, or `patience` has passed.
    void wait(std::chrono::milliseconds patience) const { preparation_.wait(patience); }
    /// Whether nothing that was asked for is missing.
    bool is_complete() const { return requested_.empty(); }

    /// Whether a level is resident; also where nothing is that could stand in its place.
    bool can_draw(scene::Index geometry, const mesh::DetailLevel& level) const;

    // Of what was not asked for before, all is made and copied at once.
    const GpuGeometry& geometry(scene::Index index);
    /// Of an item: its level's, if it has one; else the file's, or level 0, which has the same triangles.
    const GpuGeometry& geometry(const plan::DrawItem& item);
    /// Null while they are not resident.
    const GpuEdges* edges(scene::Index index) const;
    /// Its triangles in an item's order, which is not null. Items of the same geometry and order share them.
    /// Beyond kMaxSortedBytes those that have not been asked for the longest are given back; a result is
    /// valid until the next call.
    const GpuTriangles& sorted_triangles(const plan::DrawItem& item);
    static constexpr std::size_t kMaxSortedBytes = std::size_t{32} << 20;
    const GlTexture& texture(scene::Index index);
    /// Of the six textures (cube_map_data()).
    const GlTexture& cube_map(const std::array<scene::Index, 6>& textures);
    /// Geometries, their levels, orders and edges, textures and cube maps uploaded so far.
    int uploads() const { return uploads_; }

private:
    /// On its way to the GPU.
    struct Arrival {
        Preparation::Result result;
        bool has_storage = false;
        GpuGeometry geometry = {};
        GpuEdges edges = {};
        GlTexture texture = {};
        Upload upload = {};
    };
    bool is_resident(const ResourceKey& key) const;
    template <class Make>
    bool request(const ResourceKey& key, Need need, const Make& make);
    bool request_geometry(scene::Index index, Need need);
    bool request_texture(scene::Index index);
    bool request_cube_map(const std::array<scene::Index, 6>& textures);
    std::function<PreparedData()> make_texture(scene::Index index) const;
    std::function<PreparedData()> make_cube_map(const std::array<scene::Index, 6>& textures) const;
    const scene::Geometry& read_geometry(scene::Index index) const {
        return scene_->geometries()[static_cast<std::size_t>(index)];
    }
    /// Buffers that small geometries share. They are freed with the last geometry in them.
    struct SharedBuffers {
        /// Of a small geometry. Buffers hold twice as many as those before them, up to kMostVertices, and
        /// three indices for each vertex.
        static constexpr std::size_t kMostVerticesOfSmall = 3 * plan::kMostTrianglesOfSmall,
                                     kMostVertices = std::size_t{1} << 15;
        std::weak_ptr<const GeometryBuffers> buffers;
        std::size_t capacity = kMostVerticesOfSmall;  ///< in vertices
        std::size_t vertices = 0, indices = 0;        ///< that are taken, from the beginning
    };
    void create_storage(Arrival& arrival);
    std::shared_ptr<const GeometryBuffers> share_buffers(GpuGeometry& geometry, std::size_t vertices,
                                                         std::size_t indices, bool texcoords);
    void create_geometry(Arrival& arrival);
    void create_edges(Arrival& arrival);
    bool proceed(Arrival& arrival, plan::DrawBudget& budget);
    void finish(Arrival& arrival);
    void upload_at_once(const ResourceKey& key, const std::function<PreparedData()>& make);

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
    std::array<SharedBuffers, 2>
        shared_;  // those that are being filled: without and with texture coordinates
    int uploads_ = 0;

    Preparation preparation_;
    std::map<ResourceKey, Need> requested_;  // and not resident yet
    std::set<ResourceKey> failed_;           // of those that are needed soon
    std::optional<Arrival> arrival_;         // the one that is being copied
};

}  // namespace vrut::gl
