#pragma once

#include "base/output_files.hpp"
#include "io/conversion_warnings.hpp"
#include "io/write_scene.hpp"

namespace vrut::io {

/// Binary STL: the triangles that show at the start, in world space, with their faces' normals. Names,
/// materials, vertex normals and everything else are lost. Throws WriteError.
void write_stl(const scene::Scene& scene, const std::filesystem::path& path, base::OutputFiles& files,
               ConversionWarnings& warnings, const WriteProgress& progress);

}  // namespace vrut::io
