# The report page's sources (HTML, CSS, JavaScript) become string constants in the compare library, so that the program
# needs no files beside it: compare/report/assets.h.
function(duet_embed_report TARGET)
    set(folder ${PROJECT_SOURCE_DIR}/compare/report)
    set(scripts decode.js paint.js view.js viewer.js panels.js main.js)

    file(READ ${folder}/page/report.html REPORT_HTML)
    file(READ ${folder}/page/report.css REPORT_CSS)
    set(REPORT_JS "")
    foreach(script ${scripts})
        file(READ ${folder}/page/${script} text)
        string(APPEND REPORT_JS "${text}")
    endforeach()
    file(GLOB page_files ${folder}/page/*)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${page_files})
    configure_file(${folder}/assets.cpp.in ${PROJECT_BINARY_DIR}/generated/report_assets.cpp @ONLY)

    find_package(ZLIB REQUIRED) # comes with OpenEXR, which is built on it
    target_sources(${TARGET} PRIVATE ${PROJECT_BINARY_DIR}/generated/report_assets.cpp)
    target_link_libraries(${TARGET} PRIVATE ZLIB::ZLIB)
endfunction()
