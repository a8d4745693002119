#pragma once

namespace vrut::io {

/// The formats that assimp reads for us. Of the others that it knows, none carries cars that do not come in
/// one of these as well, and each would be one more that could go wrong on files from anywhere.
enum class AssimpFormat { obj, stl, ply, collada, fbx };

/// What assimp calls its reader of the format.
constexpr const char* importer_name(AssimpFormat format) {
    switch (format) {
        case AssimpFormat::obj:
            return "Wavefront Object Importer";
        case AssimpFormat::stl:
            return "Stereolithography (STL) Importer";
        case AssimpFormat::ply:
            return "Stanford Polygon Library (PLY) Importer";
        case AssimpFormat::collada:
            return "Collada Importer";
        case AssimpFormat::fbx:
            return "Autodesk FBX Importer";
    }
    return "";
}

}  // namespace vrut::io
