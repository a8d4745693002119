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
/// Wavefront OBJ with its MTL, STL, PLY, Collada and FBX, text or binary where there are both. Most of their
/// materials are Phong's already, and their colours as displayed:
///     diffuse   the diffuse colour, with the opacity as alpha unless that is a texture
///     ambient   the diffuse colour / 10: their own is to be multiplied by a light that the files do not tell
///     specular  the specular colour times its factor, or black where there is no exponent
///     shininess the exponent, from 1 to 10,000
///     emission  the emissive colour, or black where there is an emissive texture: that is the emissive
///               image, as bright as the emissive colour in linear light, or as it is where that is black
/// and the diffuse texture as the image, whose alpha counts only where it is the opacity texture too. Where
/// the file tells metal or roughness (Pm and Pr in OBJ; 3ds Max's Physical and PBR materials, and Maya's
/// Stingray, Standard Surface and Arnold's in FBX), the material is by metal and roughness, with a clear
/// coat; its emission is emissive light. A normal map is the normal image, unless it is grey: then it is a
/// bump map. Colours of vertices multiply ambient and diffuse, and are shown as they are where there is no
/// material; STL and PLY without colours take the default material's. Images that are not where the file says
/// are looked for beside it. Which sides of a surface are seen these formats do not tell: materials are
/// two-sided, but for those that are opaque and on parts only that are closed and wound outwards
/// (is_watertight()), which look the same from one side. What is wound inwards may be a room or a mistake:
/// both are right when two-sided. Normals are the file's; without any, and in STL, triangles are flat. Equal
/// vertices become one. y is up in Collada and FBX, whatever the file's axis; in OBJ, STL and PLY, which do
/// not tell, it is y, or z by ReadOptions::z_up. FBX keeps its unit, Collada is scaled to metres.
PartsResult read_assimp_scene(const std::filesystem::path& path, AssimpFormat format,
                              const ReadProgress& progress = {}, const ReadOptions& options = {});

/// For the table of readers.
template <AssimpFormat format>
PartsResult read_assimp_scene(const std::filesystem::path& path, const ReadProgress& progress,
                              const ReadOptions& options) {
    return read_assimp_scene(path, format, progress, options);
}

}  // namespace vrut::io
