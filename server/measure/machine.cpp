#include "measure/machine.hpp"

#include <fstream>
#include <thread>

namespace vrut::server::measure {

std::string machine() {
    std::ifstream stream("/proc/cpuinfo");
    std::string name = "a processor";
    for (std::string line; std::getline(stream, line);)
        if (line.starts_with("model name")) {
            name = line.substr(line.find(':') + 2);
            break;
        }
    return name + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads";
}

}  // namespace vrut::server::measure
