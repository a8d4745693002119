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

#include "gl/geometry_buffers.hpp"
#include "gl/gpu_cuts.hpp"
#include "gl/handles.hpp"
#include "gl/preparation.hpp"
#include "gl/upload.hpp"
#include "plan/draw_groups.hpp"
#include "plan/frame_plan.hpp"
#include "scene/scene.hpp"

namespace vrut::gl {

/// A geometry's triangles in another order (plan::TriangleOrder). It never changes, since a draw that is
/// queued on the GPU may still read it.
struct GpuTriangles {
    scene::Index geometry = scene::kNone;
    std::shared_ptr<const std::vector<unsigned>> order;
    GlBuffer indices;
    GlVertexArray vertex_array;  ///< with the geometry's vertices
    GLsizei index_count = 0;
};

/// scene::EnvironmentLight.
struct GpuEnvironmentLight {
    GlTexture prefiltered;
    std::array<glm::dvec3, 9> harmonics{};
};

/// The geometries and textures of a scene on the GPU. Threads prepare their data when it is first requested
/// (Preparation); upload() copies it in steps.
class GpuScene {
public:
    explicit GpuScene(std::shared_ptr<const scene::Scene> scene);
    const std::shared_ptr<const scene::Scene>& scene() const { return scene_; }

    // Each requests what is not resident, and returns true if all is resident.
    /// All that the view's nodes show, inside the image or outside it.
    bool request_shown(const plan::View& view);
    /// The faces of an item. `levels` own its level, if it has one.
    bool request(const plan::DrawItem& item, const std::shared_ptr<const mesh::DetailLevels>& levels);
    bool request(scene::Index geometry, const mesh::DetailLevel& level,
                 const std::shared_ptr<const mesh::DetailLevels>& levels, Need need);
    bool request_edges(const plan::DrawItem& item, Need need);
    bool request_background(const plan::View& view);

    /// Copies prepared data until `budget` is spent. Throws OutOfMemory for what is needed now, as the
    /// lookups below do. What is needed soon and does not fit is not requested again as such.
    void upload(plan::DrawBudget& budget);
    /// Returns once there is data to copy, or after `patience`.
    void wait(std::chrono::milliseconds patience) const { preparation_.wait(patience); }
    /// Returns true if all that was requested is resident.
    bool is_complete() const { return requested_.empty(); }

    /// Returns true if the level is resident, or if no other level can stand in for it.
    bool can_draw(scene::Index geometry, const mesh::DetailLevel& level) const;

    // Lookups. What was not requested before is prepared and copied at once.
    const GpuGeometry& geometry(scene::Index index);
    /// Returns the cap of the item's cut, if it has one; its level, if it has one; else the file's geometry,
    /// or level 0, which has the same triangles.
    const GpuGeometry& geometry(const plan::DrawItem& item);
    /// An edge that several triangles share is there once, even if their corners have different normals. Null
    /// while they are not resident.
    const GpuEdges* edges(scene::Index index) const;
    /// Of an item with a cut.
    const GpuEdges& cut_lines(const plan::DrawItem& item) { return cut(item).lines; }
    /// Returns the item's triangles in its order, which is not null. Items of the same geometry and order
    /// share them. Beyond kMaxSortedBytes the least recently used are freed. The result is valid until the
    /// next call.
    const GpuTriangles& sorted_triangles(const plan::DrawItem& item);
    static constexpr std::size_t kMaxSortedBytes = std::size_t{32} << 20;
    const GlTexture& texture(scene::Index index);
    /// Of the six textures (cube_map_data()).
    const GlTexture& cube_map(const std::array<scene::Index, 6>& textures);
    /// True if some material needs environment_light().
    bool is_lit_by_environment() const { return lit_by_environment_; }
    const GpuEnvironmentLight& environment_light(const std::array<scene::Index, 6>& textures);
    /// Geometries, their levels, orders and edges, textures and cube maps uploaded so far.
    int uploads() const { return uploads_; }

private:
    /// Prepared data that is being copied.
    struct Arrival {
        Preparation::Result result;
        bool has_storage = false;
        GpuGeometry geometry = {};
        std::vector<glm::uvec3> turned_triangles = {};
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
    bool request_environment_light(const std::array<scene::Index, 6>& textures);
    std::function<PreparedData()> make_texture(scene::Index index) const;
    std::function<PreparedData()> make_cube_map(const std::array<scene::Index, 6>& textures) const;
    std::function<PreparedData()> make_environment_light(const std::array<scene::Index, 6>& textures) const;
    const scene::Geometry& read_geometry(scene::Index index) const {
        return scene_->geometries()[static_cast<std::size_t>(index)];
    }
    void create_storage(Arrival& arrival);
    void create_geometry(Arrival& arrival);
    void create_edges(Arrival& arrival);
    bool proceed(Arrival& arrival, plan::DrawBudget& budget);
    void finish(Arrival& arrival);
    void upload_at_once(const ResourceKey& key, const std::function<PreparedData()>& make);

    std::shared_ptr<const scene::Scene> scene_;
    std::vector<GpuGeometry> geometries_;
    std::map<std::pair<scene::Index, int>, GpuGeometry> levels_;  // by geometry and the level's number
    std::vector<std::optional<GpuEdges>> edges_;  // freed before the geometries, whose vertices they use
    struct ByOrder {
        bool operator()(const GpuTriangles* a, const GpuTriangles* b) const;
    };
    const GpuCut& cut(const plan::DrawItem& item) {
        return cuts_.at(item.cut, read_geometry(item.geometry), scene_->needs_double_single(item.geometry));
    }
    const std::vector<glm::uvec3>& uploaded_triangles(scene::Index geometry);
    GpuTriangles upload_sorted(const plan::DrawItem& item);

    std::list<GpuTriangles> sorted_triangles_;  // the latest used first
    std::map<const GpuTriangles*, std::list<GpuTriangles>::iterator, ByOrder> sorted_by_order_;
    std::size_t sorted_bytes_ = 0;
    std::map<scene::Index, std::vector<glm::uvec3>> uploaded_triangles_;  // of those with sorted triangles
    std::vector<GlTexture> textures_;
    std::map<std::array<scene::Index, 6>, GlTexture> cube_maps_;
    std::map<std::array<scene::Index, 6>, GpuEnvironmentLight> environment_lights_;
    bool lit_by_environment_ = false;  // some material needs them
    GpuCuts cuts_;
    GeometryBufferPool buffer_pool_;
    int uploads_ = 0;

    Preparation preparation_;
    std::map<ResourceKey, Need> requested_;  // and not resident yet
    std::set<ResourceKey> failed_;           // with Need::soon
    std::optional<Arrival> arrival_;
};

}  // namespace vrut::gl
