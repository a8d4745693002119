#include "reported_state.hpp"

#include <algorithm>
#include <limits>

#include "state_descriptions.hpp"

namespace vrut::protocol {

namespace {

const Json& section_of(const StateDocument& document, const char* name) {
    static const Json none = Json::object();
    const Json& section = document.section(name);
    return section.is_null() ? none : read_object(section, name);
}

/// Entries by their `order`, then those without one, by name.
std::vector<std::pair<std::string, const Json*>> in_order(const Json& entries) {
    std::vector<std::pair<std::string, const Json*>> sorted;
    sorted.reserve(entries.size());
    for (const auto& [name, entry] : entries.items()) sorted.emplace_back(name, &read_object(entry, name));
    std::ranges::stable_sort(sorted, {}, [](const auto& entry) {
        const auto order = entry.second->find("order");
        return order != entry.second->end() && order->is_number() ? order->template get<double>()
                                                                  : std::numeric_limits<double>::infinity();
    });
    return sorted;
}

/// A camera of the scene's own may lie beyond what a message may give.
std::optional<CameraOverlay> camera_in(const Json& view) {
    const auto camera = or_error([&] { return read_struct<CameraOverlay>(view, "view"); });
    return camera ? std::optional(*camera) : std::nullopt;
}

ReportedState read_reported(const StateDocument& state) {
    ReportedState reported;
    const Json& scene = section_of(state, "scene");
    for (const char* member : {"name", "file"})
        if (reported.scene.empty())
            reported.scene = read_string(scene.value(member, Json("")), member, kName.max);
    for (const auto& [name, note] : section_of(state, "markers").items())
        reported.notes[name] = read_struct<Marker>(read_object(note, name), "markers");
    for (const auto& [name, view] : in_order(section_of(state, "views")))
        reported.views.push_back({name, camera_in(*view)});
    for (const auto& [name, cue] : in_order(section_of(state, "cues")))
        reported.cues.push_back({name, read_string(cue->value("text", Json("")), "text", kMaxCueText)});
    const Json& measured = section_of(state, "measured");
    for (const auto& [name, measure] : section_of(state, "measures").items()) {
        const auto result = measured.find(name);
        reported.measures.push_back(
            {name, read_struct<MeasureState>(read_object(measure, name), "measures").kind,
             result == measured.end() ? MeasuredState{} : read_struct<MeasuredState>(*result, "measured")});
    }
    reported.unit = read_struct<UnitState>(section_of(state, "unit"), "unit");
    return reported;
}

}  // namespace

tl::expected<ReportedState, Error> reported_state(const StateDocument& document) {
    return or_error([&] { return read_reported(document); });
}

}  // namespace vrut::protocol
