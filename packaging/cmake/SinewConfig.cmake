# Package of an unpacked archive: find_package(Sinew) gives the target Sinew::sinew.

include("${CMAKE_CURRENT_LIST_DIR}/SinewChoice.cmake")
get_filename_component(_sinew_root "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
sinew_choose_library(_sinew_name)
set(_sinew_library "${_sinew_root}/lib/${_sinew_name}/libsinew.a")

if(NOT EXISTS "${_sinew_library}")
    set(Sinew_FOUND FALSE)
    set(Sinew_NOT_FOUND_MESSAGE "this archive has no library ${_sinew_name}; make one: packaging/archive --libraries ${_sinew_name}")
elseif(NOT TARGET Sinew::sinew)
    add_library(Sinew::sinew STATIC IMPORTED GLOBAL)
    set_target_properties(Sinew::sinew PROPERTIES
        IMPORTED_LOCATION "${_sinew_library}"
        IMPORTED_LINK_INTERFACE_LANGUAGES C
        INTERFACE_INCLUDE_DIRECTORIES "${_sinew_root}/include")
endif()
