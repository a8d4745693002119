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
#include "scene/scene.hpp"

namespace vrut::gl {

/// Names what a scene has on the GPU.
struct ResourceKey {
    enum class Kind { geometry, level, edges, texture, cube_map };
    Kind kind = Kind::geometry;
    /// The geometry, and the number of its level; or the texture; or the six of a cube map.
    std::array<scene::Index, 6> indices{};

    bool operator<(const ResourceKey& other) const {
        return std::tie(kind, indices) < std::tie(other.kind, other.indices);
    }
};

/// A resource in memory, as the GPU takes it: of a geometry or a level its arrays and texture coordinates, or
/// the others.
struct PreparedData {
    VertexArrays arrays;
    std::vector<glm::vec2> texcoords;
    std::vector<glm::uvec2> edges;
    TextureData texture;

    std::size_t bytes() const;
};

/// Whether a picture waits for a resource, or is drawn without it.
enum class Need { now, soon };

/// Makes the data of resources on two threads of its own, one for each Need, in the order in which they are
/// asked for. The threads pause while kMostBytes of data wait to be taken.
class Preparation {
public:
    static constexpr std::size_t kMostBytes = std::size_t{64} << 20;

    Preparation();
    /// Drops what is not begun, and waits for nothing: a thread that makes something ends by itself after it.
    ~Preparation();
    Preparation(const Preparation&) = delete;
    Preparation& operator=(const Preparation&) = delete;

    /// `make` owns all that it uses. Where no thread can be had, it is called at once.
    void post(const ResourceKey& key, Need need, std::function<PreparedData()> make);

    struct Result {
        ResourceKey key;
        PreparedData data;
        std::exception_ptr error;  ///< what `make` threw; null: nothing
    };
    /// The next that is made; none if there is none yet.
    std::optional<Result> take();
    /// Until there is one to be taken, or `patience` has passed.
    void wait(std::chrono::milliseconds patience) const;

private:
    struct State;
    std::shared_ptr<State> state_;  // the threads', too
};

}  // namespace vrut::gl
