#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "reported_state.hpp"

namespace vrut::server::report {

/// Most pictures of one report.
inline constexpr std::size_t kMostPictures = 60;
/// Most bytes of their files together, but for the last.
inline constexpr std::size_t kMostPictureBytes = std::size_t{16} << 20;

/// What the pictures of a report show: of the notes, the cues and the views, in the order in which html()
/// takes them; the first kMostPictures.
std::vector<protocol::OtherView> pictures_of(const protocol::ReportedState& state);

/// A JPEG file; null: it cannot be drawn.
using Picture = std::shared_ptr<const std::string>;

/// One HTML file without references to others. `pictures`: those of pictures_of(), or the
/// first ones. `made`: milliseconds since 1970, UTC.
std::string html(const protocol::ReportedState& state, const std::vector<Picture>& pictures,
                 std::int64_t made);

/// The notes by RFC 4180, in UTF-8 with a byte order mark, without which spreadsheets take another encoding.
/// A text that they would compute has an apostrophe before it.
std::string csv(const protocol::ReportedState& state);

/// Milliseconds since 1970 as a time of ISO 8601, in UTC, to the second.
std::string iso_time(std::int64_t ms);

/// A measure's value in the unit that is shown, as pages write it in English; empty where it has none.
std::string value_words(const protocol::ReportedState::Measure& measure, const protocol::UnitState& unit);

}  // namespace vrut::server::report
