#pragma once

#include "io/conversion_warnings.hpp"
#include "io/osb/file.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// Converts OpenSG's materials by the rules in osb/scene.hpp.
class OsbMaterials {
public:
    OsbMaterials(const OsbFile& file, ConversionWarnings& warnings) : file_(file), warnings_(warnings) {}

    /// Returns the index in `all` of the material with this id, converted on first use; kNone if the id is
    /// not one of a supported material. Throws OsbError.
    scene::Index take(std::uint32_t id);

    std::vector<scene::Material> all;
    std::vector<scene::Texture> textures;  ///< that lie in the file

private:
    void read_simple(const OsbContainer& from, scene::Material& material);
    void read_chunks(const OsbContainer& from, scene::Material& material);
    void read_image(std::uint32_t id, scene::Material& material);
    scene::Index decode(const OsbContainer& image, OsbCursor pixels);

    const OsbFile& file_;
    ConversionWarnings& warnings_;
    std::unordered_map<std::uint32_t, scene::Index, base::SaltedHash> known_, known_textures_;
};

}  // namespace vrut::io
