#include "engine/scene_lookup.hpp"

namespace vrut::server::engine {

namespace code = protocol::error_code;

namespace {

constexpr std::chrono::seconds kBetweenListings{1};
constexpr std::chrono::milliseconds kWaitsForListing{100};  // a loaded machine starts a thread late
constexpr std::chrono::seconds kWaitsForFile{5};
constexpr std::size_t kMostFindings = 64;  // that wait

}  // namespace

void SceneLookup::list(std::int64_t request, base::Clock::time_point now) {
    list_requests_.push_back(request);
    if (!lists_ && now >= list_again_) {
        list_again_ = now + kBetweenListings;
        list_until_ = now + kWaitsForListing;
        lists_ = run_file_work([this, names = folder_.names, post = post_] {
            post->send([this, listed = names()] { this->listed(listed); });
        });
    }
    if (!lists_ || now >= list_until_) send_list();
}

void SceneLookup::listed(std::vector<std::string> names) {
    lists_ = false;
    names_ = std::move(names);
    send_list();
}

void SceneLookup::send_list() {
    for (const std::int64_t request : std::exchange(list_requests_, {}))
        post_->send([=, this] { on_listed_(request, names_); });
}

void SceneLookup::find(std::int64_t request, const protocol::Open& asked, base::Clock::time_point now) {
    if (findings_.size() == kMostFindings)
        return cannot_find({request, asked, now}, code::busy, "too many scenes are being looked for");
    findings_.push_back({request, asked, now + kWaitsForFile});
    if (!finds_) find_next();
}

void SceneLookup::find_next() {
    if (findings_.empty()) return;
    finding_ = findings_.front().request;
    finds_ = run_file_work([this, name = findings_.front().asked.scene, find = folder_.find, post = post_] {
        post->send([this, path = find(name)] { found(path); });
    });
    if (finds_) return;
    for (const Finding& finding : std::exchange(findings_, {}))
        cannot_find(finding, code::failed, "a scene cannot be loaded now: no thread can be had");
}

void SceneLookup::found(const tl::expected<std::filesystem::path, std::string>& path) {
    finds_ = false;
    if (!findings_.empty() && findings_.front().request == finding_) {
        const Finding found = findings_.front();
        findings_.pop_front();
        on_found_(found.request, {found.asked, path.map_error([](const std::string& why) {
                                      return protocol::Error{{}, code::refused_scene, why};
                                  })});
    }
    find_next();
}

void SceneLookup::cannot_find(const Finding& finding, const char* code, const std::string& why) {
    post_->send([=, this] {
        on_found_(finding.request, {finding.asked, tl::unexpected(protocol::Error{{}, code, why})});
    });
}

std::optional<base::Clock::time_point> SceneLookup::due() const {
    std::optional<base::Clock::time_point> first;
    if (!findings_.empty()) first = findings_.front().until;
    if (!list_requests_.empty()) first = std::min(first.value_or(list_until_), list_until_);
    return first;
}

void SceneLookup::check(base::Clock::time_point now) {
    if (!list_requests_.empty() && now >= list_until_) send_list();
    for (; !findings_.empty() && now >= findings_.front().until; findings_.pop_front())
        cannot_find(findings_.front(), code::busy, "the folder of scenes does not answer");
}

}  // namespace vrut::server::engine
