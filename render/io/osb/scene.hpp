#pragma once

#include <string_view>

#include "io/read_scene.hpp"

namespace vrut::io {

/// Reads a scene in the OpenSG binary format 1.0 (see OsbFile), as OpenSG 1.8 writes it: its nodes, numbered
/// from the root downwards as they stand in the file, with their names, and of their cores groups,
/// transforms, geometries, switches, levels of detail by distance, lights, and groups that give a material to
/// all below them, of which the topmost counts. Geometries that share their arrays are one. Other containers
/// are skipped, with a notice for each type. Cameras have no place in OpenSG's graph. A light is placed at
/// its beacon, and shines on the whole scene.
///
/// Colours are as displayed in both. A SimpleMaterial, or a ChunkMaterial by its MaterialChunk, becomes
///     ambient   0.2 ambient: what OpenGL's light of 0.2 from everywhere makes of it
///     diffuse, specular, emission and shininess as they are, with alpha 1 - transparency or the diffuse
///     one's without light: emission is the diffuse colour, and all others are black
/// two-sided unless a PolygonChunk culls back faces, and the image of its SimpleTexturedMaterial or its
/// TextureChunk as the image: one without compression inside the file, or a file in its folder or below.
///
/// Errors say "FILE: at byte N: expected …, found …". Takes at most 200 times the file's memory.
PartsResult read_osb_scene(const std::filesystem::path& path, const ReadProgress& progress = {},
                           const ReadOptions& options = {});

/// The same from memory, without the images that lie outside; `file` names it in errors and notices.
PartsResult read_osb_parts(std::string_view bytes, const std::string& file,
                           const ReadProgress& progress = {});

}  // namespace vrut::io
