set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The VRUT Preview authors <vrut-preview@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/compress.cmake)
# So that the unit, made when it is installed, names /usr and not the folder in which the package is made.
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL server client)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_SERVER_PACKAGE_NAME ${PROJECT_NAME})
set(CPACK_DEBIAN_SERVER_PACKAGE_SECTION graphics)
# A driver, which no program is linked with: one that draws in software is among Mesa's.
set(CPACK_DEBIAN_SERVER_PACKAGE_DEPENDS "libgl1-mesa-dri")
# Loaded when a film is written.
if(LIBAV_FOUND)
    set(CPACK_DEBIAN_SERVER_PACKAGE_RECOMMENDS "libavformat59, libswscale6")
endif()
set(CPACK_DEBIAN_SERVER_PACKAGE_SUGGESTS "haproxy, nats-server")
set(CPACK_DEBIAN_SERVER_DESCRIPTION "remote preview renderer for automotive VR
A server that draws a scene, as a car, without a window, and sends images
to tablets, hosts and scripts. It has a page for a presenter's tablet, a
car, teaching scenes, and systemd units.")
set(CPACK_DEBIAN_SERVER_PACKAGE_CONTROL_EXTRA
    "${CMAKE_CURRENT_LIST_DIR}/postinst;${CMAKE_CURRENT_LIST_DIR}/prerm;${CMAKE_CURRENT_LIST_DIR}/postrm")

set(CPACK_DEBIAN_CLIENT_PACKAGE_NAME libvrut-client-dev)
set(CPACK_DEBIAN_CLIENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_CLIENT_PACKAGE_DEPENDS "libssl-dev")
set(CPACK_DEBIAN_CLIENT_DESCRIPTION "C++ client of VRUT Preview for hosts
With this library a program that shows the same scene as a VRUT Preview
server, as on the walls of a CAVE, follows the shared camera, tells what it
shows, and may lead.")

# What Debian wants of every package: its copyright, and a changelog in Debian's own format.
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
foreach(component server client)
    string(TOUPPER ${component} COMPONENT)
    set(package ${CPACK_DEBIAN_${COMPONENT}_PACKAGE_NAME})
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/${package})
    set(doc ${CMAKE_INSTALL_DATADIR}/doc/${package})
    configure_file(${CMAKE_CURRENT_LIST_DIR}/changelog.in ${folder}/changelog @ONLY)
    install(FILES ${folder}/changelog DESTINATION ${doc} COMPONENT ${component} EXCLUDE_FROM_ALL)
    install(FILES ${CMAKE_CURRENT_LIST_DIR}/lintian-overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides RENAME ${package}
        COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()
install(FILES ${CMAKE_CURRENT_LIST_DIR}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libvrut-client-dev
    COMPONENT client EXCLUDE_FROM_ALL)

include(CPack)
