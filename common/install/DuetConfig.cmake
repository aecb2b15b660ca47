# The CMake package of an installed Duet: find_package(Duet), then the targets Duet::raster and Duet::raytrace, and
# Duet::common and Duet::image, which they stand on. They bring their compile flags along.
include(CMakeFindDependencyMacro)
find_dependency(tinyobjloader CONFIG)
find_dependency(nlohmann_json CONFIG)
find_dependency(CLI11 CONFIG)
find_dependency(TBB CONFIG)
find_dependency(OpenEXR CONFIG)
find_dependency(xsimd CONFIG)
set_property(TARGET xsimd PROPERTY INTERFACE_LINK_LIBRARIES "") # Debian's names a library that no package has
include(${CMAKE_CURRENT_LIST_DIR}/DuetTargets.cmake)
