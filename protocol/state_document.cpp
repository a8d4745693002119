#include "state_document.hpp"

#include <algorithm>
#include <array>

#include "state_descriptions.hpp"

namespace vrut::protocol {

struct StateDocument::Section {
    std::string name;
    Json json;
    Json changed;  ///< like `json`, with each leaf the revision that changed it last
};

namespace {

constexpr const char* kGone = "";  // no member has an empty name

/// Null where there is none.
const Json& member(const Json& parent, const std::string& name) {
    static const Json kNone;
    if (!parent.is_object()) return kNone;
    const auto found = parent.find(name);
    return found == parent.end() ? kNone : *found;
}

/// `changed` brought up to date for a step from `from` to `to`.
Json mark_changes(const Json& from, const Json& to, const Json& changed, std::int64_t revision) {
    if (!to.is_object()) return from == to && changed.is_number() ? changed : Json(revision);
    Json result = Json::object();
    for (const auto& [name, value] : to.items())
        result[name] = mark_changes(member(from, name), value, member(changed, name), revision);
    // What went leaves its mark, so that a patch that counts on it is found stale. Marks of what went long
    // ago are kept as one, for all: names that come and go must not pile up.
    constexpr std::size_t kMostGone = 1000;
    std::int64_t gone = changed.is_object() ? changed.value(kGone, std::int64_t{0}) : 0;
    const auto is_gone = [&](const std::string& name) { return !to.contains(name); };
    if (changed.is_object())
        for (const auto& [name, mark] : changed.items())
            if (is_gone(name) && name != kGone) result[name] = mark;
    if (from.is_object())
        for (const auto& [name, value] : from.items())
            if (is_gone(name)) result[name] = revision;
    if (result.size() - to.size() > kMostGone) {
        std::erase_if(result.get_ref<Json::object_t&>(),
                      [&](const auto& entry) { return is_gone(entry.first); });
        gone = revision;
    }
    if (gone > 0) result[kGone] = gone;
    return result;
}

std::int64_t newest(const Json& changed) {
    if (changed.is_number()) return changed.get<std::int64_t>();
    std::int64_t result = 0;
    for (const auto& [name, value] : changed.items()) result = std::max(result, newest(value));
    return result;
}

std::int64_t newest_named(const Json& changed, const Json& patch) {
    if (!patch.is_object() || !changed.is_object()) return newest(changed);
    std::int64_t result = 0;
    for (const auto& [name, value] : patch.items())
        if (const auto found = changed.find(name); found != changed.end())
            result = std::max(result, newest_named(*found, value));
        else
            result = std::max(result, changed.value(kGone, std::int64_t{0}));
    return result;
}

}  // namespace

std::shared_ptr<const StateDocument> StateDocument::next(const StateDocument& previous, const State& state) {
    return next(previous, state, previous.revision_ + 1);
}

std::shared_ptr<const StateDocument> StateDocument::next(const StateDocument& previous, const State& state,
                                                         std::int64_t revision) {
    auto document = std::make_shared<StateDocument>(previous);
    document->revision_ = revision;
    document->state_ = state;
    const std::vector<Field>& fields = table_of<State>().fields;
    const bool first = previous.sections_.empty();
    if (first) document->sections_.resize(fields.size());
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const Field& field = fields[i];
        if (!first && field.type->equal(field.in(&state), field.in(&previous.state_))) continue;
        const void* value = field.value_in(&state);
        auto fresh =
            std::make_shared<Section>(Section{field.name, value ? field.kind->write(value) : Json(), {}});
        fresh->changed = first ? mark_changes({}, fresh->json, {}, revision)
                               : mark_changes(previous.sections_[i]->json, fresh->json,
                                              previous.sections_[i]->changed, revision);
        document->sections_[i] = std::move(fresh);
    }
    return document;
}

tl::expected<std::shared_ptr<const StateDocument>, std::string> StateDocument::received(
    std::string_view text, const StateDocument* known) {
    const auto read = [&]() -> std::shared_ptr<const StateDocument> {
        const Json message = parse_strictly(text);
        read_object(message, "message");
        constexpr std::array<std::string_view, 2> kTypes{"state", "patch"};
        const bool is_patch = read_word(member(message, "type"), "type", kTypes) == 1;
        if (is_patch && !known)
            throw BadJson{error_code::bad_message, "a patch came before the state that it changes"};
        auto document = std::make_shared<StateDocument>();
        document->revision_ = read_integer(member(message, "revision"), "revision", 1, kMaxInteger);
        const Json& sections = read_object(member(message, is_patch ? "patch" : "state"), "state");
        for (std::size_t i = 0; i < table_of<State>().fields.size(); ++i) {
            const std::string name = table_of<State>().fields[i].name;
            if (is_patch && !sections.contains(name)) {
                document->sections_.push_back(known->sections_[i]);
                continue;
            }
            Json json = is_patch ? known->sections_[i]->json : Json();
            if (const Json& change = member(sections, name); is_patch)
                json.merge_patch(change);
            else
                json = change;
            document->sections_.push_back(
                std::make_shared<Section>(Section{name, std::move(json), document->revision_}));
        }
        return document;
    };
    return or_error(read).map_error([](const Error& error) { return error.message; });
}

std::shared_ptr<const StateDocument> StateDocument::for_hosts() const {
    const auto place = [&](const char* name) {
        return std::ranges::find(sections_, name, [](const auto& section) { return section->name; });
    };
    const auto walls = place("walls"), camera = place("camera");
    if (walls == sections_.end() || camera == sections_.end() || (*walls)->json.is_null()) return nullptr;
    Json json = (*walls)->json;
    json.erase("behindDegrees");
    json.erase("behindMetres");
    auto document = std::make_shared<StateDocument>();
    document->revision_ = revision_;
    document->sections_ = sections_;
    document->sections_[static_cast<std::size_t>(camera - sections_.begin())] =
        std::make_shared<Section>(Section{"camera", std::move(json), revision_});
    return document;
}

const Json& StateDocument::section(std::string_view name) const {
    static const Json none;
    const auto found = std::ranges::find(sections_, name,
                                         [](const auto& section) { return std::string_view(section->name); });
    return found == sections_.end() ? none : (*found)->json;
}

std::optional<std::string> StateDocument::holder() const {
    const Json& control = section("control");
    const auto holder = control.is_object() ? control.find("holder") : control.end();
    return holder != control.end() && holder->is_string() ? std::optional(holder->get<std::string>())
                                                          : std::nullopt;
}

bool StateDocument::has_scene_of(const StateDocument& other) const {
    const Json &own = section("scene"), &others = other.section("scene");
    return &own == &others || own == others;
}

Json StateDocument::json() const {
    Json state = Json::object();
    for (const auto& section : sections_)
        if (!section->json.is_null()) state[section->name] = section->json;
    return state;
}

std::string StateDocument::encode() const {
    return dump({{"type", "state"}, {"revision", revision_}, {"state", json()}});
}

std::string StateDocument::encode_patch_from(const StateDocument& earlier, const std::string& by) const {
    Json patch = Json::object();
    for (std::size_t i = 0; i < sections_.size(); ++i) {
        if (sections_[i] == earlier.sections_[i]) continue;
        const Json &from = earlier.sections_[i]->json, &to = sections_[i]->json;
        if (!from.is_object() || !to.is_object()) {
            if (from != to) patch[sections_[i]->name] = to;
        } else if (Json diff = merge_diff(from, to); !diff.empty()) {
            patch[sections_[i]->name] = std::move(diff);
        }
    }
    Json message = {{"type", "patch"}, {"revision", revision_}, {"patch", std::move(patch)}};
    if (!by.empty()) message["by"] = by;
    return dump(message);
}

std::int64_t StateDocument::last_change(const Json& patch) const {
    std::int64_t result = 0;
    for (const auto& section : sections_)
        if (const auto named = patch.find(section->name); named != patch.end())
            result = std::max(result, newest_named(section->changed, *named));
    return result;
}

}  // namespace vrut::protocol
