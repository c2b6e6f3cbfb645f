# While installing: manual pages and completions of `asdic_program`, as it writes them itself. Below the prefix, in `asdic_datadir`.
set(share "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/${asdic_datadir}")
get_filename_component(name "${asdic_program}" NAME)

# said(<variable> <words>...): what the program says.
function(said variable)
  execute_process(COMMAND "${asdic_program}" help ${ARGN} OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()

# a page for the program, and for each command that its page refers to
function(page command file)
  execute_process(COMMAND "${asdic_program}" help --man ${command} COMMAND gzip -9n OUTPUT_FILE "${file}" COMMAND_ERROR_IS_FATAL ANY)
  list(APPEND CMAKE_INSTALL_MANIFEST_FILES "${file}")
  set(CMAKE_INSTALL_MANIFEST_FILES "${CMAKE_INSTALL_MANIFEST_FILES}" PARENT_SCOPE)
endfunction()
file(MAKE_DIRECTORY "${share}/man/man1")
page("" "${share}/man/man1/${name}.1.gz")
said(manual --man)
string(REGEX MATCHALL "\n\\.TP\n\\.BR [^\n]* \\(1\\)" commands "${manual}")
string(REPLACE "\\-" "-" commands "${commands}")
list(TRANSFORM commands REPLACE "\n\\.TP\n\\.BR ${name}-(.*) \\(1\\)" "\\1")
foreach(command IN LISTS commands)
  page(${command} "${share}/man/man1/${name}-${command}.1.gz")
endforeach()

foreach(shell_file IN ITEMS bash:bash-completion/completions/${name} zsh:zsh/vendor-completions/_${name}
                            fish:fish/vendor_completions.d/${name}.fish)
  string(REGEX MATCH "^(.*):(.*)$" matched "${shell_file}")
  set(shell "${CMAKE_MATCH_1}")
  set(file "${share}/${CMAKE_MATCH_2}")
  get_filename_component(folder "${file}" DIRECTORY)
  file(MAKE_DIRECTORY "${folder}")
  execute_process(COMMAND "${asdic_program}" help --completion ${shell} OUTPUT_FILE "${file}" COMMAND_ERROR_IS_FATAL ANY)
  list(APPEND CMAKE_INSTALL_MANIFEST_FILES "${file}")
endforeach()
