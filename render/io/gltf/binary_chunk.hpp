#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <vector>

#include "io/gltf/json_writer.hpp"
#include "io/write_scene.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// The binary chunk of a GLB file: geometries, each once, and pictures behind them; one buffer view for each
/// array and picture, and one accessor for each array, in the order of the bytes.
class GltfBinaryChunk {
public:
    /// Places of a geometry's accessors; kNone for arrays that it lacks.
    struct Accessors {
        int positions = scene::kNone, normals = scene::kNone, texcoords = scene::kNone,
            indices = scene::kNone;
    };

    /// The geometry outlives this. Whether it is new.
    bool add(const scene::Geometry& geometry);
    void add_image(std::vector<std::uint8_t> png) { pngs_.push_back(std::move(png)); }

    const Accessors& accessors_of(const scene::Geometry& geometry) const { return accessors_.at(&geometry); }
    std::size_t image_count() const { return pngs_.size(); }
    std::size_t view_of_image(std::size_t i) const { return static_cast<std::size_t>(accessor_count_) + i; }

    /// Writes members of the document: accessors, buffer views and the buffer. Gives the chunk's size in
    /// bytes.
    std::uint64_t describe(JsonWriter& json) const;
    void write(std::ostream& out, const WriteProgress& progress) const;

private:
    std::vector<const scene::Geometry*> geometries_;
    std::map<const scene::Geometry*, Accessors> accessors_;
    std::vector<std::vector<std::uint8_t>> pngs_;
    int accessor_count_ = 0;
};

}  // namespace vrut::io
