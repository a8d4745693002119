#pragma once

#include <limits>

#include "fields.hpp"
#include "messages.hpp"

/// What several descriptions have in common. For protocol's own .cpp files.
namespace vrut::protocol {

// Far beyond any screen, near enough that sums and products stay finite.
inline constexpr Number kCoordinate{-1e6, 1e6};
inline constexpr Number kDelta{-1e9, 1e9};
inline constexpr Number kTimeStamp{-1e15, 1e15};
inline constexpr Number kAny{-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
inline constexpr Number kDuration{0, std::numeric_limits<double>::max()};
inline constexpr double kHuge = kFarthest;
inline constexpr Vector kPosition{-kHuge, kHuge};
inline constexpr List kLine{Vector{kAny.min, kAny.max}, 0, kMaxLine};
inline constexpr Vector kColor{0, 1};
inline constexpr Vector kLightColor{0, kHuge};  // light may be brighter than white
inline constexpr Vector kAttenuation{0, kHuge};
inline constexpr Number kFov{1, 170};
inline constexpr Number kSpeed{0.01, 100};
inline constexpr Number kOrder{-1e9, 1e9};
inline constexpr Number kCueMs{0, 60'000};
inline constexpr Matrix kMatrix{kHuge};
inline constexpr Integer kId{};
inline constexpr Integer kDate{0, kLatestDate};
inline constexpr Integer kPixels{1, 8192};
inline constexpr Integer kJpegQuality{1, 100};
inline constexpr Text kName{std::numeric_limits<std::uint32_t>::max()};
inline constexpr Text kClientName{kMaxClientName};
inline constexpr std::size_t kMaxKeyframes = 1000;
inline constexpr std::size_t kMaxQrSize = 177;  // modules of a side, in version 40

inline constexpr Integer kActiveChild{-2, std::numeric_limits<int>::max()};
inline constexpr auto kRole = word("control", "view", "host");
inline constexpr auto kMode = word("realistic", "stylized");
inline constexpr auto kFormat = word("jpeg", "png");
inline constexpr auto kStyle = word("vrut", "maya", "catia", "cinema4d");
inline constexpr auto kTurnAbout = word("center", "touched");
inline constexpr auto kUpAxis = word("y", "z");
inline constexpr auto kSnap = word("point", "vertex", "midpoint", "center", "edge", "loop", "plane");

// Definitions of the schema's own.
inline constexpr Object kCameraOverlay{"cameraOverlay"};
inline constexpr Object kQuality{"quality"};
inline constexpr Object kNotice{"notice"};
inline constexpr Section kCamera{"camera"};
inline constexpr Object kFeature{"feature"};

inline void describe(Fields<CameraOverlay>& v) {
    v.optional("node", &CameraOverlay::node, kId, "A camera node, whose pose is laid over first.");
    v.optional("eye", &CameraOverlay::eye, kPosition, "Where the camera stands.");
    v.optional("focus", &CameraOverlay::focus, kPosition, "What it looks at.");
    v.optional("up", &CameraOverlay::up, kPosition, "Which way is up in the image.");
    v.optional("center", &CameraOverlay::center, kPosition, "The centre of rotation.");
    v.optional("fov", &CameraOverlay::fov, kFov, "The vertical angle of view in degrees.");
}

/// The members of a pose, of a struct that is one.
template <class T>
void describe_pose(Fields<T>& v) {
    v.writable("eye", &Pose::eye, kPosition, "Where the camera stands.");
    v.writable("focus", &Pose::focus, kPosition, "What it looks at.");
    v.writable("up", &Pose::up, kPosition,
               "Which way is up in the image; unit, at right angles to the view.");
    v.writable("center", &Pose::center, kPosition, "The centre of rotation.");
    v.writable("fov", &Pose::fov, kFov, "The vertical angle of view in degrees.");
}
inline void describe(Fields<Pose>& v) { describe_pose(v); }
/// Of a pose that comes whole.
inline const FieldTable& table_of_whole_pose() {
    static const FieldTable table = [] {
        FieldTable pose = table_of<Pose>();
        for (Field& field : pose.fields) field.presence = Presence::required;
        return pose;
    }();
    return table;
}

inline void describe(Fields<Feature>& v) {
    v.required("node", &Feature::node, kId, "The node whose surface it is on.");
    v.required("snap", &Feature::snap, kSnap, "What it is.");
    v.required("points", &Feature::points, List{kPosition, 1, 3},
               "Of the node's own space: one, and for the last four kinds two more.");
}

inline void describe(Fields<Notice>& v) {
    v.fixed("code", &Notice::code, Text{kName.max, notice_code::all}, "For programs.");
    v.fixed("message", &Notice::message, kName, "A sentence for a person.");
}

inline void describe(Fields<Quality>& v) {
    v.required("level", &Quality::level, word("moving", "still"),
               "`moving` while things change, `still` at rest.");
    v.required("scale", &Quality::scale, Number{0, 1}, "By which the frame is drawn smaller than the view.");
    v.required("samples", &Quality::samples, Integer{1, 65536}, "To a pixel.");
    v.required("detail", &Quality::detail, kDuration,
               "Pixels of error allowed in the meshes; 0 draws every triangle.");
    v.required("jpegQuality", &Quality::jpeg_quality, kJpegQuality, "Of the JPEG file.");
    v.required("subsampling", &Quality::subsampling, word("4:2:0", "4:4:4"),
               "Of the colours in the JPEG file.");
    v.optional("error", &Quality::error, Number{0, 1},
               "Mean FLIP against full accuracy, 0 none, as measured for the level; missing where unknown.");
}

}  // namespace vrut::protocol
