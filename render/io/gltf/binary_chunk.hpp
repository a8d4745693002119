#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <vector>

#include "io/gltf/json_writer.hpp"
#include "io/write_scene.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// The binary chunk of a GLB file: the arrays of the geometries, each geometry once, then the images. Each
/// array and image has a buffer view, and each array an accessor, in the order of the bytes.
class GltfBinaryChunk {
public:
    /// The accessors' indices of a geometry; kNone for arrays that it lacks.
    struct Accessors {
        int positions = scene::kNone, normals = scene::kNone, texcoords = scene::kNone, colors = scene::kNone,
            indices = scene::kNone;
    };

    /// Returns true if the geometry is new. It must outlive this object.
    bool add(const scene::Geometry& geometry);
    void add_image(std::vector<std::uint8_t> png) { pngs_.push_back(std::move(png)); }

    const Accessors& accessors_of(const scene::Geometry& geometry) const { return accessors_.at(&geometry); }
    std::size_t image_count() const { return pngs_.size(); }
    std::size_t view_of_image(std::size_t i) const { return static_cast<std::size_t>(accessor_count_) + i; }

    /// Writes the document's members accessors, bufferViews and buffers. Returns the chunk's size in bytes.
    std::uint64_t describe(JsonWriter& json) const;
    void write(std::ostream& out, const WriteProgress& progress) const;

private:
    std::vector<const scene::Geometry*> geometries_;
    std::map<const scene::Geometry*, Accessors> accessors_;
    std::vector<std::vector<std::uint8_t>> pngs_;
    int accessor_count_ = 0;
};

}  // namespace vrut::io
