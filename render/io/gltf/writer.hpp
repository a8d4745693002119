#pragma once

#include "base/output_files.hpp"
#include "io/conversion_warnings.hpp"
#include "io/write_scene.hpp"

namespace vrut::io {

/// glTF 2.0, binary (.glb): nodes with their names and matrices, those that show at the start with their
/// geometries, each written once; cameras, lights (KHR_lights_punctual) and pictures; materials by
/// gltf_material(). Ids become places in the file. assimp's exporter is not used: it leaves out cameras and
/// lights, and changes names that occur twice. Throws WriteError, for more than 4 GiB too.
void write_glb(const scene::Scene& scene, const std::filesystem::path& path, base::OutputFiles& files,
               ConversionWarnings& warnings, const WriteProgress& progress);

}  // namespace vrut::io
