#pragma once

#include "base/output_files.hpp"
#include "io/conversion_warnings.hpp"
#include "io/write_scene.hpp"

namespace vrut::io {

/// Writes a scene as binary glTF 2.0 (.glb): all nodes with names and matrices, the geometries of those that
/// show at the start, each written once, cameras, lights (KHR_lights_punctual), images, and materials by
/// gltf_material(). Ids become indices. assimp's exporter is not used, since it leaves out cameras and lights
/// and renames nodes whose names occur twice. Throws WriteError, also for a file of more than 4 GiB.
void write_glb(const scene::Scene& scene, const std::filesystem::path& path, base::OutputFiles& files,
               ConversionWarnings& warnings, const WriteProgress& progress);

}  // namespace vrut::io
