#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "report/report.hpp"

namespace vrut::server::net {

struct ServedRoom;

/// Makes a report of `state`, on the net thread: draws its pictures one after the other in `room`, and calls
/// `done` with its HTML, or with none where another scene is shown meanwhile. Before each picture `goes_on`
/// is asked; false ends it without an answer. `running` counts it while it lives.
void draw_report(protocol::ReportedState state, std::shared_ptr<ServedRoom> room, std::size_t& running,
                 std::function<bool()> goes_on, std::function<void(std::optional<std::string> html)> done);

}  // namespace vrut::server::net
