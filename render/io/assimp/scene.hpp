#pragma once

#include <filesystem>

#include "io/assimp/format.hpp"
#include "io/read_scene.hpp"

namespace vrut::io {

/// Reads a scene in one of the formats that assimp knows, with its images, material libraries and buffers,
/// which lie in its folder or below it or inside it. Its nodes become assemblies and geometry nodes, numbered
/// from the root downwards as they stand in the file; a mesh that several nodes show is one geometry. What of
/// the file does not come into the scene is told by notices.
///
/// glTF 2.0, text (.gltf) or binary (.glb). One unit is a metre. Colours of glTF are linear, ours are as
/// displayed: c below is a colour factor through the transfer curve of sRGB (IEC 61966-2-1). A material with
/// base colour c, metallic m and roughness r becomes
///     diffuse   c, with the base colour's alpha where alphaMode is BLEND, else 1
///     ambient   c / 10
///     specular  (1 - r) (0.22 + (c - 0.22) m): 0.22 is how 4 %, what most surfaces reflect, displays
///     shininess (1 / r^4 - 1) / 2, from 1 to 10,000: Phong's exponent that is about as sharp as roughness r
///               (a quarter of Blinn's, 2 / r^4 - 2; B. Karis, "Specular BRDF Reference", 2013)
///     emission  the emissive factor's c, or black where there is an emissive texture
/// two-sided as the file says, and the base colour texture as the image, whose alpha counts only where
/// alphaMode is not OPAQUE.
///
/// Wavefront OBJ with its MTL, STL, PLY, Collada and FBX, text or binary where there are both. Their
/// materials are Phong's already, and their colours as displayed:
///     diffuse   the diffuse colour, with the opacity as alpha unless that is a texture
///     ambient   the diffuse colour / 10: their own is to be multiplied by a light that the files do not tell
///     specular  the specular colour times its factor, or black where there is no exponent
///     shininess the exponent, from 1 to 10,000
///     emission  the emissive colour, or black where there is an emissive texture
/// and the diffuse texture as the image, whose alpha counts only where it is the opacity texture too.
/// Colours of vertices multiply ambient and diffuse, and are shown as they are where there is no material;
/// STL and PLY without colours take the default material's. Images that are not where the file says are
/// looked for beside it. Which sides of a surface are seen these formats do not tell: materials are
/// two-sided, but for those that are opaque and on parts only that are closed and wound outwards
/// (is_watertight()), which look the same from one side. What is wound inwards may be a room or a mistake:
/// both are right when two-sided. Normals are the file's; without any, and in STL, triangles are flat. Equal
/// vertices become one. y is up in Collada and FBX, whatever the file's axis; in OBJ, STL and PLY, which do
/// not tell, it is y. FBX keeps its unit, Collada is scaled to metres.
PartsResult read_assimp_scene(const std::filesystem::path& path, AssimpFormat format,
                              const ReadProgress& progress = {});

/// For the table of readers.
template <AssimpFormat format>
PartsResult read_assimp_scene(const std::filesystem::path& path, const ReadProgress& progress) {
    return read_assimp_scene(path, format, progress);
}

}  // namespace vrut::io
