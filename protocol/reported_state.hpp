#pragma once

#include <map>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "messages.hpp"
#include "state.hpp"
#include "state_document.hpp"

namespace vrut::protocol {

/// What a report has of the state.
struct ReportedState {
    struct View {
        std::string name;
        std::optional<CameraOverlay> camera;  ///< none: it cannot be read
    };
    struct Cue {
        std::string name, text;
    };
    struct Measure {
        std::string name;
        MeasureKind kind = MeasureKind::distance;
        MeasuredState measured;
    };
    std::string scene;                    ///< its name, or that of its file where it has none
    std::map<std::string, Marker> notes;  ///< by name
    std::vector<View> views;              ///< in their order
    std::vector<Cue> cues;                ///< in their order
    std::vector<Measure> measures;        ///< by name
    UnitState unit;
};

/// Or what of the document cannot be read. It may be of another server.
tl::expected<ReportedState, Error> reported_state(const StateDocument& document);

}  // namespace vrut::protocol
