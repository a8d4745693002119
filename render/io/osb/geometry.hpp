#pragma once

#include <map>

#include "io/conversion_warnings.hpp"
#include "io/osb/file.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// Turns OpenSG's geometries into ours: points, strips, fans, quads and polygons become triangles, and what
/// is indexed by several indices gets a vertex for each tuple of them that occurs.
class OsbGeometries {
public:
    OsbGeometries(const OsbFile& file, ConversionWarnings& warnings)
        : file_(file), warnings_(warnings), work_left_(file.size()) {}

    /// The place in `all` of what a Geometry's container holds, made when it is first asked for; kNone where
    /// it has no triangles. Geometries of the same arrays are one. Throws OsbError.
    scene::Index take(const OsbContainer& container);

    std::vector<scene::Geometry> all;

private:
    scene::Index add(scene::Geometry geometry);

    const OsbFile& file_;
    ConversionWarnings& warnings_;
    std::map<std::vector<std::uint32_t>, scene::Index> known_;  // by the arrays' ids and the mapping
    std::unordered_map<std::uint32_t, scene::Index, base::SaltedHash> known_containers_;
    /// What corners and primitives of all geometries together may yet be: each takes a byte of its own,
    /// unless arrays are shared beyond measure.
    std::size_t work_left_;
};

}  // namespace vrut::io
