#pragma once

#include <map>

#include "io/conversion_warnings.hpp"
#include "io/osb/file.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// Converts OpenSG's geometries: strips, fans, quads and polygons become triangles, and multi-indexed
/// attributes become one vertex for each distinct tuple of indices.
class OsbGeometries {
public:
    OsbGeometries(const OsbFile& file, ConversionWarnings& warnings)
        : file_(file), warnings_(warnings), work_left_(file.size()) {}

    /// Returns the index in `all` of a Geometry container, converted on first use; kNone if it has no
    /// triangles. Geometries with the same arrays are one. Throws OsbError.
    scene::Index take(const OsbContainer& container);

    std::vector<scene::Geometry> all;

private:
    scene::Index add(scene::Geometry geometry);

    const OsbFile& file_;
    ConversionWarnings& warnings_;
    std::map<std::vector<std::uint32_t>, scene::Index> known_;  // by the arrays' ids and the mapping
    std::unordered_map<std::uint32_t, scene::Index, base::SaltedHash> known_containers_;
    /// How many corners and primitives all geometries together may still have. Each needs a byte of the file,
    /// unless a hostile file shares its arrays.
    std::size_t work_left_;
};

}  // namespace vrut::io
