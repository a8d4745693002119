#pragma once

#include "client_descriptions.hpp"
#include "cue_list.hpp"
#include "frame_header.hpp"
#include "level_table.hpp"
#include "render_job.hpp"
#include "state_descriptions.hpp"

/// The members of frame headers, and of files. For protocol's own .cpp files.
namespace vrut::protocol {

// --- the frame header

inline void describe(Fields<FrameHeader::Camera>& v) {
    v.inlined(&FrameHeader::Camera::pose);
    v.required("viewMatrix", &FrameHeader::Camera::view_matrix, Matrix{kAny.max},
               "From the world to the camera's space.");
    v.required("projectionMatrix", &FrameHeader::Camera::projection_matrix, Matrix{kAny.max},
               "From the camera's space to clip space.");
}

inline void describe(Fields<FrameHeader::Renderer>& v) {
    v.required("mode", &FrameHeader::Renderer::mode, kMode, "How surfaces were drawn.");
    v.required("wireframe", &FrameHeader::Renderer::wireframe, Flag{}, "Edges only.");
    v.required("showSelection", &FrameHeader::Renderer::show_selection, Flag{},
               "What is selected was brought out.");
}

inline void describe(Fields<FrameHeader::Timing>& v) {
    v.required("renderMs", &FrameHeader::Timing::render_ms, kDuration, "Drawing.");
    v.required("readbackMs", &FrameHeader::Timing::readback_ms, kDuration, "Reading the pixels back.");
    v.required("encodeMs", &FrameHeader::Timing::encode_ms, kDuration, "Encoding the file.");
    v.required("sinceInputMs", &FrameHeader::Timing::since_input_ms, kDuration,
               "From the arrival of the newest input that it shows to its hand-over to the socket.");
}

/// Without the inset, which is the client's own business.
inline const FieldTable& table_of_size() {
    static const FieldTable table = [] {
        FieldTable size = table_of<Resize>();
        std::erase_if(size.fields,
                      [](const Field& field) { return std::string_view(field.name) == "inset"; });
        return size;
    }();
    return table;
}

/// As any pose's, but for the words of one meaning.
inline const FieldTable& table_of_drawn_pose() {
    static const FieldTable table = [] {
        FieldTable pose = table_of_whole_pose();
        std::ranges::find(pose.fields, std::string_view("up"), &Field::name)->meaning =
            "Which way is up in the image.";
        return pose;
    }();
    return table;
}

inline void describe(Fields<FrameHeader::Depth>& v) {
    v.required("frame", &FrameHeader::Depth::frame, kId, "The frame that the map was made for.");
    v.required("columns", &FrameHeader::Depth::columns, Integer{1, kMostDepthBlocks}, "Blocks in a row.");
    v.required("rows", &FrameHeader::Depth::rows, Integer{1, kMostDepthBlocks}, "Rows of blocks.");
    v.required("scale", &FrameHeader::Depth::scale, Number{0, kAny.max},
               "Reciprocal distance of the nearest surface along the view.");
    v.required("backgroundTurns", &FrameHeader::Depth::background_turns, Flag{},
               "What is infinitely far turns with the camera; else it stays where it is in the image.");
    v.required("camera", &FrameHeader::Depth::camera, Object{nullptr, &table_of_drawn_pose},
               "Where image and map were drawn from; missing: from the header's `camera`.");
    v.required("bytes", &FrameHeader::Depth::bytes, kId,
               "Of the map behind this file; 0: this client has it already.");
}

inline void describe(Fields<FrameHeader>& v) {
    v.required("frame", &FrameHeader::frame, kId, "Number of the frame; it rises.");
    v.required("revision", &FrameHeader::revision, kId, "Of the state that it shows.");
    v.required("handled", &FrameHeader::handled, kId,
               "Highest `id` of this client that was handled when the state was taken; 0 before the first.");
    v.required("snapshot", &FrameHeader::snapshot, kId, "The `id` of the `snapshot` that asked for it.");
    v.required(
        "lease", &FrameHeader::lease, kId,
        "Of the server that drew it, where several share the room: it rises with each that takes over.");
    v.required("camera", &FrameHeader::camera, Object{}, "The state's camera, with matrices.");
    v.required("width", &FrameHeader::width, kId, "Pixels of this file.");
    v.required("height", &FrameHeader::height, kId, "Pixels of this file.");
    v.required("view", &FrameHeader::view, Object{nullptr, &table_of_size}, "The size of the view in force.");
    v.required("renderer", &FrameHeader::renderer, Object{}, "How it was drawn.");
    v.required("quality", &FrameHeader::quality, kQuality, "With what accuracy.");
    v.required("timing", &FrameHeader::timing, Object{}, "Milliseconds that were spent.");
    v.required("depth", &FrameHeader::depth, Object{},
               "How far away is what it shows, for clients that asked for it.");
    v.optional("markers", &FrameHeader::markers, Table{Vector{kAny.min, kAny.max}},
               "Where the markers' signs stand in the world, by name.");
}

// --- level tables

inline constexpr Number kCost{0, 1e9};  // ms or bytes: their ratios stay numbers

inline void describe(Fields<Level>& v) {
    v.required("quality", &Level::quality, kQuality,
               "As frame headers tell it. One with `level` `still` tells the `error` at rest.");
    v.required("ms", &Level::ms, kCost, "Median of drawing, reading back and encoding.");
    v.required("bytes", &Level::bytes, kCost, "Median of the files.");
    v.optional("reason", &Level::reason, Text{1000}, "Why it is in the table: a sentence.");
}

inline void describe(Fields<LevelTable>& v) {
    v.required("scene", &LevelTable::scene, Text{100}, "SHA-256 of the scene's file.");
    v.required("renderer", &LevelTable::renderer, Text{1000}, "What draws, as the server's log tells it.");
    v.required("width", &LevelTable::width, kPixels, "Of the frames measured, at scale 1.");
    v.required("height", &LevelTable::height, kPixels, "Of the frames measured, at scale 1.");
    v.required("levels", &LevelTable::levels, List{Object{}, 1, kMaxLevels}, "By rising accuracy.");
}

// --- the file of a presentation

inline void describe(Fields<CueList>& v) {
    v.required("format", &CueList::format, word("vrut-preview-cues"), "What the file is.");
    v.required("version", &CueList::version, Integer{1, CueList::kVersion}, "Of this format.");
    v.optional("scene", &CueList::scene, Text{1000}, "Name of the scene's file; missing: any.");
    v.required("cues", &CueList::cues, AnyObject{"cues"}, "As the state's `cues`.");
}

// --- the queue of images

inline void describe(Fields<RenderJob>& v) {
    v.required("run", &RenderJob::run, Text{100}, "By which the images of one film are known.");
    v.required("image", &RenderJob::image, Integer{1, kMaxFilmImages}, "Its number in the film.");
    v.required("scene", &RenderJob::scene, Text{1000}, "The scene's name in the workers' folder of scenes.");
    v.required("sha256", &RenderJob::sha256, Text{100}, "SHA-256 of all that the scene shows.");
    v.required("upAxis", &RenderJob::up_axis, kUpAxis, "Of a file that does not define it.");
    v.required("studio", &RenderJob::studio, word("automatic", "on", "off"),
               "Whether the scene is shown in a studio.");
    v.required("width", &RenderJob::width, kPixels, "Pixels.");
    v.required("height", &RenderJob::height, kPixels, "Pixels.");
    v.required("samples", &RenderJob::samples, Integer{1, 4096}, "A pixel.");
    v.required("detail", &RenderJob::detail, Number{0, 1000}, "By how many pixels surfaces may lie off.");
    v.required("format", &RenderJob::format, kFormat, "Of the image's file.");
    v.required("jpegQuality", &RenderJob::jpeg_quality, kJpegQuality, "Of a JPEG file.");
    v.required("patches", &RenderJob::patches, List{Text{kMaxMessageBytes}, 0, 100},
               "Merge patches of the state, as text.");
    v.required("camera", &RenderJob::camera, kCameraOverlay, "The whole camera.");
}

}  // namespace vrut::protocol
