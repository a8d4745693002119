#include "net/descriptors.hpp"

#include <sys/resource.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

namespace vrut::server::net {

void allow_descriptors(std::size_t needed) {
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0)
        throw std::runtime_error(std::string("the limit of open files cannot be read: ") +
                                 std::strerror(errno));
    if (limit.rlim_cur >= needed) return;
    limit.rlim_cur = needed;
    if (limit.rlim_max < needed || ::setrlimit(RLIMIT_NOFILE, &limit) != 0)
        throw std::runtime_error(std::to_string(needed) + " open files are needed for so many clients, and " +
                                 std::to_string(limit.rlim_max) +
                                 " are allowed: lower --max-clients, or raise the limit (ulimit -Hn)");
}

}  // namespace vrut::server::net
