#pragma once

#include <memory>
#include <string>
#include <vector>

#include "frame_header.hpp"
#include "plan/view.hpp"

namespace vrut::server::measure {

/// How a picture is drawn and encoded: what a measurement varies.
struct Setting {
    double scale = 1;   ///< of width and height
    int samples = 1;    ///< in a pixel
    double detail = 0;  ///< View::detail: pixels of error allowed in the meshes
    plan::Methods methods = {};
    int clip_planes = 0;      ///< with caps: 0, one through the middle of the scene, or the six of a box
    int jpeg_quality = 85;    ///< 0: the picture is not encoded
    bool subsampled = false;  ///< 4:2:0, else 4:4:4

    bool operator==(const Setting&) const = default;
};

/// In a few words: "scale 0.5, 4 samples, detail 1, JPEG 85 4:4:4".
std::string name_of(const Setting& setting);
/// As frame headers report it, for pictures while things move; without an error.
protocol::Quality quality_of(const Setting& setting);
Setting setting_of(const protocol::Quality& quality);
/// `view` as `setting` has it drawn.
plan::View view_with(plan::View view, const Setting& setting);

/// The levels of detail of a scene, all of them made: takes seconds where it has many triangles.
std::shared_ptr<const mesh::DetailLevels> detail_levels_of(
    const std::shared_ptr<const scene::PlacedScene>& scene);
/// Returns true if any geometry has a coarser surface: else `detail` changes nothing.
bool has_levels(const plan::View& view);

/// Scale, samples, detail and JPEG together, as far as they make pictures for a view that moves, then each
/// alone from the ordinary picture.
std::vector<Setting> product(bool with_detail);
/// The same in few, of one sample a pixel: what the server's table is chosen from.
std::vector<Setting> candidates(bool with_detail);
/// Them in 4:4:4, as the server sends thin lines.
std::vector<Setting> in_full_colour(std::vector<Setting> settings);
/// Settings of one thing each, not encoded, from the cheapest on; the last is the most accurate. Samples end
/// well below those of the judge.
std::vector<Setting> details();
std::vector<Setting> sample_counts();
std::vector<Setting> lights();
std::vector<Setting> transparencies();
std::vector<Setting> texture_filters();
/// None, one and six clip planes.
std::vector<Setting> clip_plane_counts();
/// The ordinary picture in each JPEG quality and subsampling.
std::vector<Setting> encodings();

}  // namespace vrut::server::measure
