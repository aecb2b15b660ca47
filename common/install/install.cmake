# What `cmake --install` installs, and the Debian package (common/install/README.md).
include(CMakePackageConfigHelpers)

# Programs, with their manual pages and completion.
set(programs raster raytrace)
if(DUET_BUILD_COMPARE)
    list(APPEND programs compare)
endif()
install(TARGETS ${programs} DESTINATION bin COMPONENT programs)
foreach(program ${programs})
    set(manual ${PROJECT_BINARY_DIR}/${program}.1.gz)
    install(CODE "execute_process(COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/manual.sh $<TARGET_FILE:${program}>
            ${PROJECT_VERSION} COMMAND gzip -9n OUTPUT_FILE ${manual} COMMAND_ERROR_IS_FATAL ANY)"
        COMPONENT shared)
    install(FILES ${manual} DESTINATION share/man/man1 COMPONENT shared)
    install(FILES ${CMAKE_CURRENT_LIST_DIR}/completion.bash DESTINATION share/bash-completion/completions
        RENAME ${program} COMPONENT shared)
endforeach()

# Models and pages. The pages lie as in the source tree; their links to sources lead nowhere.
install(DIRECTORY models DESTINATION share/duet COMPONENT shared FILES_MATCHING
    PATTERN *.json PATTERN *.obj PATTERN *.mtl PATTERN *.png PATTERN *.hdr PATTERN *.raw)
file(GLOB_RECURSE pages CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} gallery/*.svg gallery/*.jpg gallery/*.png
    common/*.md raster/*.md raster/*.png raytrace/*.md raytrace/*.png compare/*.md compare/*.png models/*.md
    gallery/*.md raster/*.svg raytrace/*.svg compare/*.svg)
foreach(page README.md ${pages})
    get_filename_component(folder ${page} DIRECTORY)
    install(FILES ${page} DESTINATION share/doc/duet/${folder} COMPONENT shared)
endforeach()
install(FILES LICENSE DESTINATION share/doc/duet COMPONENT development)

# Headers, libraries and the CMake package.
foreach(library flags image common raster raytrace)
    set_target_properties(duet_${library} PROPERTIES EXPORT_NAME ${library})
endforeach()
install(TARGETS duet_flags duet_image duet_common duet_raster duet_raytrace EXPORT DuetTargets COMPONENT development
    ARCHIVE DESTINATION lib INCLUDES DESTINATION include/duet)
install(DIRECTORY common raster raytrace DESTINATION include/duet COMPONENT development
    FILES_MATCHING PATTERN *.h PATTERN lessons EXCLUDE PATTERN api EXCLUDE PATTERN install EXCLUDE)
install(EXPORT DuetTargets NAMESPACE Duet:: DESTINATION lib/cmake/Duet COMPONENT development)
write_basic_package_version_file(DuetConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/DuetConfig.cmake ${PROJECT_BINARY_DIR}/DuetConfigVersion.cmake
    DESTINATION lib/cmake/Duet COMPONENT development)

# The Debian package: the programs of several builds, each with an instruction set of its own, and launchers.
# common/install/package.sh makes the builds.
if(NOT UNIX)
    return()
endif()
add_executable(launch ${CMAKE_CURRENT_LIST_DIR}/launch_main.cpp)
target_link_options(launch PRIVATE -s)
duet_tools(launch)
install(TARGETS ${programs} DESTINATION lib/duet/${DUET_ARCH} COMPONENT level EXCLUDE_FROM_ALL)
foreach(program ${programs})
    install(PROGRAMS $<TARGET_FILE:launch> DESTINATION bin RENAME ${program} COMPONENT launchers EXCLUDE_FROM_ALL)
endforeach()
set(maintainer "the Duet authors <nobody@duet.invalid>") # there is no address to write to
install(CODE "execute_process(COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/debian_files.sh ${PROJECT_BINARY_DIR}
        ${PROJECT_VERSION} \"${maintainer}\" COMMAND_ERROR_IS_FATAL ANY)" COMPONENT launchers EXCLUDE_FROM_ALL)
install(FILES ${PROJECT_BINARY_DIR}/copyright ${PROJECT_BINARY_DIR}/changelog.gz DESTINATION share/doc/duet
    COMPONENT launchers EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_CONTACT ${maintainer})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# These have a program of the name `compare`, too. The first name is provided by GraphicsMagick and most builds.
set(CPACK_DEBIAN_PACKAGE_CONFLICTS "imagemagick, imagemagick-6.q16hdri")
foreach(script preinst postrm)
    configure_file(${CMAKE_CURRENT_LIST_DIR}/maintainer.sh ${script} COPYONLY)
    list(APPEND CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/${script})
endforeach()
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "rasterizer and path tracer that render the same scenes")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "Duet renders one scene in two ways, by rasterization and by path tracing. It
compares the images: what differs, where that comes from, and what each way
costs. It is meant for courses on rendering. The package has the programs
raster, raytrace and compare, the models, and the pages of the course.")
set(CPACK_INSTALL_CMAKE_PROJECTS "${PROJECT_BINARY_DIR};duet;shared;/;${PROJECT_BINARY_DIR};duet;launchers;/")
foreach(build ${DUET_PACKAGE_BUILDS})
    list(APPEND CPACK_INSTALL_CMAKE_PROJECTS ${PROJECT_SOURCE_DIR}/${build} duet level /)
endforeach()
include(CPack)
