#include <iostream>
#include <stdexcept>

#include "commands/commands.hpp"
#include "commands/film.hpp"
#include "observe/log.hpp"
#include "observe/progress.hpp"
#include "room/room.hpp"
#include "scenes/library.hpp"

namespace vrut::server::commands {

void cues_command(const CuesArguments& arguments) {
    const std::string text = read_text("LIST", arguments.list), name = arguments.scene.filename().string();
    auto scene = scenes::load_scene(arguments.scene, name, observe::loading_bar(name), {{}, arguments.read});
    if (!scene) throw std::runtime_error(scene.error());
    for (const protocol::Notice& notice : scene->notices)
        observe::log_warning("notice", {{"text", notice.message}});
    const protocol::Checked checked = room::Room(*std::move(scene)).check_cues(text);
    for (const protocol::Checked::Problem& problem : checked.problems)
        std::cout << problem.message << std::endl;
    if (!checked.problems.empty())
        throw std::runtime_error(arguments.list.string() + ": not all of the list goes with " + name +
                                 "; what does not is printed");
}

}  // namespace vrut::server::commands
