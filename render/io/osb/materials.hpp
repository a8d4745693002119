#pragma once

#include "io/conversion_warnings.hpp"
#include "io/osb/file.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// Turns OpenSG's materials into ours, by the rule that osb_scene.hpp tells.
class OsbMaterials {
public:
    OsbMaterials(const OsbFile& file, ConversionWarnings& warnings) : file_(file), warnings_(warnings) {}

    /// The place in `all` of the material with this id, made when it is first asked for; kNone for an id that
    /// is none of a material that is known. Throws OsbError.
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
