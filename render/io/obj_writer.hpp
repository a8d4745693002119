#pragma once

#include "base/output_files.hpp"
#include "io/conversion_warnings.hpp"
#include "io/write_scene.hpp"

namespace vrut::io {

/// Wavefront OBJ with an MTL file of the same stem: each geometry node that shows at the start as an object
/// in world space, named after it, with positions and texture coordinates to 9 digits; materials with Ka Kd
/// Ks Ke Ns d map_Kd, and map_d where that image has holes. Names are one word and differ: what is not a
/// letter or a digit becomes '_', and a second one gets its node's or material's id. Throws WriteError.
void write_obj(const scene::Scene& scene, const std::filesystem::path& path, base::OutputFiles& files,
               ConversionWarnings& warnings, const WriteProgress& progress);

}  // namespace vrut::io
