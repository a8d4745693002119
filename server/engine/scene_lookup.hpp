#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "base/clock.hpp"
#include "engine/file_work.hpp"

namespace vrut::server::engine {

/// Looks into the folder of scenes, which may lie on a slow disk, for requests that have a number each. To be
/// used on one thread, which also gets the results.
class SceneLookup {
public:
    /// On any thread.
    struct Folder {
        std::function<std::vector<std::string>()> names;
        std::function<tl::expected<std::filesystem::path, std::string>(const std::string& name)> find;
    };
    using OnListed = std::function<void(std::int64_t request, const std::vector<std::string>& names)>;
    /// The file, or why there is none: `refused-scene`; `busy` where the folder does not answer; `failed`
    /// where nobody can look.
    struct Found {
        protocol::Open asked;
        tl::expected<std::filesystem::path, protocol::Error> path;
    };
    using OnFound = std::function<void(std::int64_t request, const Found& found)>;

    SceneLookup(Folder folder, std::shared_ptr<ResultPost> post, OnListed on_listed, OnFound on_found)
        : folder_(std::move(folder)),
          post_(std::move(post)),
          on_listed_(std::move(on_listed)),
          on_found_(std::move(on_found)) {}

    /// Lists the folder, at most once a second. After 100 ms without an answer of the disk it sends the
    /// previous list.
    void list(std::int64_t request, base::Clock::time_point now);
    /// Finds one scene after the other. Answers `busy` after 5 s or if too many wait, `failed` if no thread
    /// can be started.
    void find(std::int64_t request, const protocol::Open& asked, base::Clock::time_point now);
    /// When check() is to be called next, if at all.
    std::optional<base::Clock::time_point> due() const;
    /// Answers those that have waited long enough.
    void check(base::Clock::time_point now);

private:
    struct Finding {
        std::int64_t request = 0;
        protocol::Open asked;
        base::Clock::time_point until;
    };
    void cannot_find(const Finding& finding, const char* code, const std::string& why);
    void listed(std::vector<std::string> names);
    void find_next();
    void found(const tl::expected<std::filesystem::path, std::string>& path);
    void send_list();

    Folder folder_;
    std::shared_ptr<ResultPost> post_;
    OnListed on_listed_;
    OnFound on_found_;

    std::vector<std::string> names_;  ///< as they were listed last
    bool lists_ = false;
    base::Clock::time_point list_again_{}, list_until_{};
    std::vector<std::int64_t> list_requests_;  ///< that wait for the list
    bool finds_ = false;
    std::deque<Finding> findings_;
    std::int64_t finding_ = 0;  ///< the request that is looked for, which may no longer wait
};

}  // namespace vrut::server::engine
