#include "commands/libav.hpp"

#include <dlfcn.h>

#include <stdexcept>

namespace vrut::server::commands {

SharedLibrary::SharedLibrary(const std::string& name)
    : name_(name), library_(dlopen(name.c_str(), RTLD_LAZY | RTLD_LOCAL)) {
    if (!library_) throw std::runtime_error(name + " cannot be loaded");
}

void* SharedLibrary::find(const char* function) const {
    void* const found = dlsym(library_, function);
    if (!found) throw std::runtime_error(name_ + " has no function " + function);
    return found;
}

const Libav& libav() {
    static const Libav all;
    return all;
}

}  // namespace vrut::server::commands
