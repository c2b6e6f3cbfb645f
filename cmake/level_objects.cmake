# Joins the objects of each instruction level into one, hides what is not to be seen, and writes the table of jumps.
# cmake -D MADE=<where> -D FOLDER=<name> -D LD=... -D OBJCOPY=... -D NM=... -P level_objects.cmake
# Reads MADE/<level>.objects; writes MADE/<name>_<level>.o, the same with everything to be seen (.._open.o: for tests), and
# MADE/jumps.S.
cmake_minimum_required(VERSION 3.25)
set(LEVELS v2 v3 v4)

function(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
  set(said "${said}" PARENT_SCOPE)
endfunction()

# Functions that every level has under the same name. One with a vector type in its name is a level's own.
foreach(level IN LISTS LEVELS)
  set(open ${MADE}/${FOLDER}_${level}_open.o)
  run(${LD} -r --force-group-allocation -o ${open} @${MADE}/${level}.objects)
  run(${NM} --defined-only --extern-only --format=posix ${open})
  string(REGEX MATCHALL "[^\n]+" lines "${said}")
  set(functions "")
  set(unique "")  # GNU's mark of what is once in a process, which objcopy makes local only after it was made weak
  foreach(line IN LISTS lines)
    if(line MATCHES "^([^ ]+) T ")
      list(APPEND functions ${CMAKE_MATCH_1})
    elseif(line MATCHES "^([^ ]+) u ")
      string(APPEND unique "${CMAKE_MATCH_1}\n")
    elseif(line MATCHES "^([^ ]+) [BDRSG] ")
      message(FATAL_ERROR "levels: ${CMAKE_MATCH_1} is a variable that others may see; make it local or a function")
    endif()
  endforeach()
  if(unique)  # an empty list is refused
    file(WRITE ${MADE}/${level}.unique "${unique}")
    run(${OBJCOPY} --weaken-symbols=${MADE}/${level}.unique ${open})
  endif()
  if(NOT DEFINED shared)
    set(shared ${functions})
  endif()
  set(both "")
  foreach(name IN LISTS shared)
    if(name IN_LIST functions)
      list(APPEND both ${name})
    endif()
  endforeach()
  set(shared ${both})
endforeach()

foreach(level IN LISTS LEVELS)
  set(open ${MADE}/${FOLDER}_${level}_open.o)
  set(hidden ${MADE}/${FOLDER}_${level}.o)
  set(renamed "")
  set(seen "")
  foreach(name IN LISTS shared)
    string(APPEND renamed "${name} ${name}.${level}\n")
    string(APPEND seen "${name}.${level}\n")
  endforeach()
  file(WRITE ${MADE}/${level}.renamed "${renamed}")
  file(WRITE ${MADE}/${level}.seen "${seen}")
  run(${OBJCOPY} --redefine-syms=${MADE}/${level}.renamed ${open} ${MADE}/${level}.renamed.o)
  run(${OBJCOPY} --keep-global-symbols=${MADE}/${level}.seen ${MADE}/${level}.renamed.o ${hidden})
  file(REMOVE ${MADE}/${level}.renamed.o)
endforeach()

# A slot holds the function of v2 until it is filled.
list(LENGTH shared count)
set(text "/* Written by cmake/level_objects.cmake: jumps to the functions of the instruction level that runs. */\n  .text\n")
set(slots "")
set(number 0)
foreach(name IN LISTS shared)
  math(EXPR offset "8 * ${number}")
  string(APPEND text "  .globl ${name}\n  .type ${name}, @function\n  .p2align 4\n${name}:\n  jmp *slots+${offset}(%rip)\n"
                     "  .size ${name}, .-${name}\n")
  string(APPEND slots "  .quad ${name}.v2\n")
  math(EXPR number "${number} + 1")
endforeach()
string(APPEND text "choose:\n  leaq slots(%rip), %rdi\n  leaq alternatives(%rip), %rsi\n  movl $${count}, %edx\n"
                   "  jmp asdic_choose_level@PLT\n"
                   "  .section .init_array.00101, \"aw\", @init_array\n  .p2align 3\n  .quad choose\n"
                   "  .data\n  .p2align 6\nslots:\n${slots}"
                   "  .section .data.rel.ro, \"aw\", @progbits\n  .p2align 6\nalternatives:\n")
foreach(level IN LISTS LEVELS)
  foreach(name IN LISTS shared)
    string(APPEND text "  .quad ${name}.${level}\n")
  endforeach()
endforeach()
string(APPEND text "  .section .note.GNU-stack, \"\", @progbits\n")
file(WRITE ${MADE}/jumps.S "${text}")
