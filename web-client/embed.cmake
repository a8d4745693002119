# Writes OUT, a C++ source with the table of page_files.hpp: what ESBUILD makes of app.js, of all that it imports and of
# the style sheets in FOLDER, and the other FILES (separated by commas) as they are.
# The references of index.html are changed to lead to the folder named by content, and a modulepreload is added for
# each file that app.js imports at once. Those that are loaded when they are needed (`import('…')`) have none.
cmake_minimum_required(VERSION 3.25)
find_program(GZIP gzip REQUIRED)
set(types_html "text/html; charset=utf-8")
set(types_css "text/css; charset=utf-8")
set(types_js "text/javascript; charset=utf-8")
set(types_png "image/png")
set(types_webmanifest "application/manifest+json")
string(REPLACE "," ";" files "${FILES}")

cmake_path(REMOVE_EXTENSION OUT LAST_ONLY OUTPUT_VARIABLE bundle)
file(REMOVE_RECURSE ${bundle})
execute_process(
    COMMAND ${ESBUILD} app.js style.css trust.css --bundle --splitting --format=esm --minify --charset=utf8 --log-level=warning
            --chunk-names=[name]-[hash] --outdir=${bundle} --metafile=${bundle}.json
    WORKING_DIRECTORY ${FOLDER} COMMAND_ERROR_IS_FATAL ANY)
file(GLOB bundled RELATIVE ${bundle} ${bundle}/*)

# Where a file of the page lies.
function(locate file result)
    set(${result} ${FOLDER}/${file} PARENT_SCOPE)
    if(file STREQUAL "index.html")
        set(${result} ${OUT}.index.html PARENT_SCOPE)
    elseif(file IN_LIST bundled)
        set(${result} ${bundle}/${file} PARENT_SCOPE)
    endif()
endfunction()
list(APPEND files ${bundled})

file(READ ${FOLDER}/index.html index)
set(hashes "${index}")
foreach(file IN LISTS files)
    if(NOT file STREQUAL "index.html")
        locate(${file} path)
        file(SHA256 ${path} hash)
        string(APPEND hashes "${file} ${hash}\n")
    endif()
endforeach()
string(SHA256 version "${hashes}")
string(SUBSTRING ${version} 0 16 version)
set(page page-${version})

# What an installed page is known by, its manifest, keeps its address.
foreach(file IN LISTS files)
    if(NOT file MATCHES "\\.webmanifest$")
        string(REPLACE "href=\"${file}\"" "href=\"${page}/${file}\"" index "${index}")
        string(REPLACE "src=\"${file}\"" "src=\"${page}/${file}\"" index "${index}")
    endif()
endforeach()

# The files that app.js imports at once, and that these import.
file(READ ${bundle}.json meta)
file(RELATIVE_PATH folder ${FOLDER} ${bundle})
set(preloads "")
set(reached "${folder}/app.js")
while(reached)
    list(POP_FRONT reached file)
    string(JSON count LENGTH "${meta}" outputs ${file} imports)
    if(count EQUAL 0)
        continue()
    endif()
    math(EXPR last "${count} - 1")
    foreach(i RANGE ${last})
        string(JSON kind GET "${meta}" outputs ${file} imports ${i} kind)
        string(JSON path GET "${meta}" outputs ${file} imports ${i} path)
        cmake_path(GET path FILENAME name)
        if(kind STREQUAL "import-statement" AND NOT preloads MATCHES "/${name}\"")
            string(APPEND preloads "  <link rel=\"modulepreload\" href=\"${page}/${name}\">\n")
            list(APPEND reached ${path})
        endif()
    endforeach()
endwhile()
string(REPLACE "</head>" "${preloads}</head>" index "${index}")
file(WRITE ${OUT}.index.html "${index}")

# The bytes of a file as a C++ string literal.
function(literal path result)
    file(READ ${path} bytes HEX)
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" bytes "${bytes}")
    set(${result} "{\"${bytes}\", sizeof \"${bytes}\" - 1}" PARENT_SCOPE)
endfunction()

set(table "")
foreach(file IN LISTS files)
    locate(${file} path)
    cmake_path(GET file EXTENSION LAST_ONLY extension)
    string(SUBSTRING "${extension}" 1 -1 extension)
    if(NOT DEFINED types_${extension})
        message(FATAL_ERROR "${file}: the server has no content type for this extension; add it to embed.cmake")
    endif()
    literal(${path} bytes)
    set(gzip "{}")
    if(NOT extension STREQUAL "png")
        execute_process(COMMAND ${GZIP} -9 -n -c ${path} OUTPUT_FILE ${OUT}.gz COMMAND_ERROR_IS_FATAL ANY)
        literal(${OUT}.gz gzip)
    endif()
    file(SHA256 ${path} hash)
    string(SUBSTRING ${hash} 0 16 hash)
    string(APPEND table "    {\"${file}\", \"${types_${extension}}\",\n     ${bytes},\n     ${gzip},\n     \"${hash}\"},\n")
endforeach()
file(WRITE ${OUT} "#include \"page_files.hpp\"\n\nnamespace vrut {\nnamespace {\n\n"
    "constexpr PageFile kPageFiles[] = {\n${table}};\n\n}  // namespace\n\n"
    "std::span<const PageFile> page_files() { return kPageFiles; }\n"
    "std::string_view page_folder() { return \"/${page}/\"; }\n\n}  // namespace vrut\n")
