#pragma once

#include "room_relay.hpp"
#include "shared_descriptions.hpp"

/// The members of the messages between servers of rooms and edges. For protocol's own .cpp files.
namespace vrut::protocol {

inline constexpr std::size_t kMostText = std::size_t{256} << 20;  // of documents
inline constexpr std::size_t kMostOfOne = 100'000;                // clients of an edge
inline constexpr Text kAnyText{kMostText};
inline constexpr Integer kCount{};

inline void describe(Fields<EdgeClient>& v) {
    v.required("client", &EdgeClient::client, kName, "Its name in the state.");
    v.required("role", &EdgeClient::role, kRole, "Asked for.");
    v.optional("token", &EdgeClient::token, Text{1000}, "As it gave it.");
    v.optional("name", &EdgeClient::name, Text{kMaxClientName}, "As it calls itself.");
    v.optional("resume", &EdgeClient::resume, Text{1000}, "As it gave it.");
    v.optional("id", &EdgeClient::id, kCount, "Of its hello.");
    v.optional("handled", &EdgeClient::handled, kCount, "The last message whose handling is known.");
}
inline void describe(Fields<EdgeSync>& v) {
    v.required("version", &EdgeSync::version, kCount, "Of these messages.");
    v.required("clients", &EdgeSync::clients, List{Object{}, 0, kMostOfOne}, "All of the edge.");
}
inline void describe(Fields<EdgeAlive>&) {}
inline void describe(Fields<EdgeAdmission>& v) {
    v.required("number", &EdgeAdmission::number, kCount, "Comes back with the answer.");
    v.required("role", &EdgeAdmission::role, kRole, "Asked for.");
    v.optional("token", &EdgeAdmission::token, Text{1000}, "As the client gave it.");
}
inline void describe(Fields<EdgeJoined>& v) {
    v.required("joined", &EdgeJoined::client, Object{}, "Who came.");
}
inline void describe(Fields<EdgeLeft>& v) { v.required("client", &EdgeLeft::client, kName, "Who left."); }
inline void describe(Fields<EdgeSaid>& v) {
    v.required("client", &EdgeSaid::client, kName, "Who said it.");
    v.required("sequence", &EdgeSaid::sequence, kCount, "Of this client's messages.");
    v.required("text", &EdgeSaid::text, Text{kMaxMessageBytes}, "The message.");
    v.optional("again", &EdgeSaid::again, Flag{}, "It was sent before.");
}
inline void describe(Fields<EdgeWanted>& v) {
    v.required("client", &EdgeWanted::client, kName, "Who wants frames.");
    v.required("newerThan", &EdgeWanted::newer_than, kCount, "Number of a frame.");
    v.required("count", &EdgeWanted::count, Integer{0, 1000}, "At most so many.");
    v.required("since", &EdgeWanted::since_sequence, kCount,
               "They show what its messages up to this one did.");
    v.optional("depth", &EdgeWanted::depth, Flag{}, "With depth.");
    v.optional("onlyWarped", &EdgeWanted::only_warped, Flag{}, "Whoever gets them warps them.");
    v.optional("bytesPerSecond", &EdgeWanted::bytes_per_second, Number{1e-3, kFastestLink}, "Of its link.");
    v.optional("roundTripMs", &EdgeWanted::round_trip_ms, Number{0, 1e9}, "Of its link.");
}
inline void describe(Fields<EdgeSnapshotSent>& v) {
    v.required("client", &EdgeSnapshotSent::client, kName, "Who got it.");
}
inline void describe(Fields<OtherView>& v) {
    v.optional("cue", &OtherView::cue, Text{100}, "The scene as this cue shows it.");
    v.optional("camera", &OtherView::camera, kCameraOverlay, "Laid over the camera.");
}
inline void describe(Fields<EdgePicture>& v) {
    v.required("name", &EdgePicture::name, kName, "By which it is known.");
    v.required("width", &EdgePicture::width, Integer{0, 1 << 20}, "Pixels.");
    v.required("height", &EdgePicture::height, Integer{0, 1 << 20}, "Pixels.");
    v.inlined(&EdgePicture::view);
}

inline void describe(Fields<RoomAnswer>& v) {
    v.required("client", &RoomAnswer::client, kName, "For whom it is.");
    v.required("text", &RoomAnswer::text, kAnyText, "The message.");
    v.required("revision", &RoomAnswer::revision, kCount, "Of the state that it must know.");
}
inline void describe(Fields<RoomHandled>& v) {
    v.required("client", &RoomHandled::client, kName, "Whose messages were handled.");
    v.required("sequence", &RoomHandled::sequence, kCount, "Of the last.");
}
inline void describe(Fields<RoomPointed>& v) {
    v.required("client", &RoomPointed::client, kName, "Who points.");
    v.required("text", &RoomPointed::text, kAnyText, "A message for all.");
}
inline void describe(Fields<RoomOutput>& v) {
    v.optional("edge", &RoomOutput::edge, kName, "All that this one has to know.");
    v.optional("state", &RoomOutput::state, kAnyText, "A `state` or a `patch`.");
    v.optional("from", &RoomOutput::from, kCount, "The revision before a `patch`.");
    v.optional("by", &RoomOutput::by, kAnyText, "Who made it.");
    v.optional("bySince", &RoomOutput::by_since, kCount, "The first revision made by the same.");
    v.optional("answers", &RoomOutput::answers, List{Object{}, 0, kMostOfOne}, "In this order.");
    v.optional("again", &RoomOutput::again, Flag{}, "Some of the answers may have come before.");
    v.optional("failed", &RoomOutput::failed_pictures, List{kName, 0, kMostOfOne},
               "Images that cannot be drawn.");
    v.optional("handled", &RoomOutput::handled, List{Object{}, 0, kMostOfOne}, "Messages.");
    v.optional("width", &RoomOutput::width, Integer{0, 1 << 20}, "Of an image of the view.");
    v.optional("height", &RoomOutput::height, Integer{0, 1 << 20}, "Of an image of the view.");
    v.optional("present", &RoomOutput::present_frame, kCount, "The frame that shows what is to be seen.");
    v.optional("stats", &RoomOutput::stats, kAnyText, "A message for all.");
    v.optional("loading", &RoomOutput::loading, kAnyText, "A message for all.");
    v.optional("loads", &RoomOutput::loads, Flag{}, "Loading goes on.");
    v.optional("pointed", &RoomOutput::pointed, List{Object{}, 0, kMostOfOne}, "Of each client the newest.");
}
inline void describe(Fields<RoomAlive>& v) {
    v.required("version", &RoomAlive::version, kCount, "Of these messages.");
    v.required("edges", &RoomAlive::edges, List{kName, 0, kMostOfOne}, "That are known.");
    v.required("renderer", &RoomAlive::renderer, kAnyText, "What draws.");
    v.required("maxPixels", &RoomAlive::max_pixels, kCount, "Of an image.");
    v.required("maxSide", &RoomAlive::max_side, Integer{0, 1 << 20}, "Of an image.");
    v.optional("unready", &RoomAlive::unready, kAnyText, "Why it cannot draw.");
}
inline void describe(Fields<RoomAdmitted>& v) {
    v.required("edge", &RoomAdmitted::edge, kName, "That has asked.");
    v.required("question", &RoomAdmitted::question, kCount, "Of the question.");
    v.optional("role", &RoomAdmitted::role, kRole, "That the client gets.");
    v.optional("why", &RoomAdmitted::why, kAnyText, "It may not come in.");
}
inline void describe(Fields<RoomApplied>& v) {
    v.required("client", &RoomApplied::client, kName, "Whose messages it shows.");
    v.required("id", &RoomApplied::id, kCount, "The highest.");
    v.required("sequence", &RoomApplied::sequence, kCount, "The last.");
}
inline void describe(Fields<RoomPicture>& v) {
    v.required("frame", &RoomPicture::frame, kCount, "Its number.");
    v.required("revision", &RoomPicture::revision, kCount, "Of the state.");
    v.optional("handled", &RoomPicture::handled, kCount, "The highest message that it shows.");
    v.optional("snapshot", &RoomPicture::snapshot, kCount, "The message that asked for it.");
    v.optional("client", &RoomPicture::client, kName, "Who asked for it.");
    v.required("format", &RoomPicture::format, kFormat, "Of the bytes.");
    v.required("header", &RoomPicture::header, kAnyText, "What it says about itself.");
    v.required("headerOffset", &RoomPicture::header_offset, kCount, "Where in the bytes the header goes.");
    v.optional("depthFrame", &RoomPicture::depth_frame, kCount, "Whose map of depth follows.");
    v.optional("depthBytes", &RoomPicture::depth_bytes, kCount, "Of that map, the last of all.");
    v.optional("applied", &RoomPicture::applied, List{Object{}, 0, kMostOfOne}, "By client.");
    v.optional("newestInputMs", &RoomPicture::newest_input_ms, Number{-1e15, 1e15}, "Arrival.");
    v.required("idleSinceMs", &RoomPicture::idle_since_ms, Number{-1e15, 1e15}, "The newest change.");
    v.required("sentMs", &RoomPicture::sent_ms, Number{-1e15, 1e15}, "Now.");
}
inline void describe(Fields<RoomLeft>&) {}

}  // namespace vrut::protocol
