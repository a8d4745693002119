#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "gl/gpu_textures.hpp"
#include "gl/vertex_arrays.hpp"
#include "mesh/triangle_clusters.hpp"
#include "scene/scene.hpp"

namespace vrut::gl {

/// Identifies a resource of a scene on the GPU.
struct ResourceKey {
    enum class Kind { geometry, level, edges, texture, cube_map, environment_light };
    Kind kind = Kind::geometry;
    /// The geometry and the number of its level; or the texture; or the six textures of a cube map, or of
    /// one that lights surfaces.
    std::array<scene::Index, 6> indices{};

    bool operator<(const ResourceKey& other) const {
        return std::tie(kind, indices) < std::tie(other.kind, other.indices);
    }
};

/// A resource in memory, in the layout of the GPU. A geometry or a level fills the first five members,
/// another kind of resource one of the others.
struct PreparedData {
    VertexArrays arrays;
    std::vector<mesh::TriangleCluster> clusters;
    std::vector<glm::vec3> low_positions;
    std::vector<glm::vec2> texcoords;
    std::vector<glm::vec3> colors;
    std::vector<glm::uvec2> edges;
    TextureData texture;
    std::array<glm::dvec3, 9> harmonics{};  ///< scene::EnvironmentLight's

    std::size_t bytes() const;
};

/// An image waits for a resource that it needs now. It is drawn without one that is needed soon.
enum class Need { now, soon };

/// Prepares the data of resources on two threads, one for each Need, in the order of the requests. The
/// threads pause while kMostBytes of data wait to be taken.
class Preparation {
public:
    static constexpr std::size_t kMostBytes = std::size_t{64} << 20;

    Preparation();
    /// Drops what is not begun, and does not wait. A thread ends after what it is making.
    ~Preparation();
    Preparation(const Preparation&) = delete;
    Preparation& operator=(const Preparation&) = delete;

    /// `make` owns all that it uses. It is called at once if no thread can be started.
    void post(const ResourceKey& key, Need need, std::function<PreparedData()> make);

    struct Result {
        ResourceKey key;
        PreparedData data;
        std::exception_ptr error;  ///< what `make` threw; null: nothing
    };
    /// Returns the next result, or none if there is none yet.
    std::optional<Result> take();
    /// Returns once there is a result, or after `patience`.
    void wait(std::chrono::milliseconds patience) const;

private:
    struct State;
    std::shared_ptr<State> state_;  // the threads', too
};

}  // namespace vrut::gl
