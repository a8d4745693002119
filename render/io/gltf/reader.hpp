#pragma once

#include <filesystem>

#include "io/read_scene.hpp"

namespace vrut::io {

/// Reads a glTF 2.0 file, text (.gltf) or binary (.glb), with its images and buffers, which lie in its folder
/// or below it or inside it (Khronos, glTF 2.0 Specification). Its nodes become assemblies and geometry
/// nodes, numbered from the root downwards as they stand in the file; a mesh that several nodes show, or one
/// in several instances (EXT_mesh_gpu_instancing), is one geometry. A primitive whose material depends on the
/// variant (KHR_materials_variants) is a switch with a child for each variant. What of the file does not come
/// into the scene is told by notices.
///
/// One unit is a metre. Colours of glTF are linear, ours are as displayed: c below is a colour factor through
/// the transfer curve of sRGB (IEC 61966-2-1). A material with base colour c, metallic m and roughness r
/// becomes metallic-roughness m r, with a clear coat (KHR_materials_clearcoat), and for views without a
/// cube map
///     diffuse   c, with the base colour's alpha where alphaMode is BLEND, else 1
///     ambient   c / 10
///     specular  (1 - r) (0.22 + (c - 0.22) m): 0.22 is how 4 %, what most surfaces reflect, displays
///     shininess (1 / r^4 - 1) / 2, from 1 to 10,000: Phong's exponent that is about as sharp as roughness r
///               (a quarter of Blinn's, 2 / r^4 - 2; B. Karis, "Specular BRDF Reference", 2013)
///     emissive  the emissive factor, linear as it is, times KHR_materials_emissive_strength; its texture is
///               the emissive image
/// two-sided as the file says, and the base colour texture as the image: its linear colours are multiplied by
/// the base colour factor, and its alpha counts only where alphaMode is not OPAQUE. One that is unlit
/// (KHR_materials_unlit) has its base colour and its image as emissive ones and is black else, but where the
/// image's alpha counts: it stays lit, without a highlight. How images lie (KHR_texture_transform) is in the
/// texture coordinates. Colours of vertices become displayed ones by the same curve.
PartsResult read_gltf_scene(const std::filesystem::path& path, const ReadProgress& progress = {},
                            const ReadOptions& options = {});

}  // namespace vrut::io
