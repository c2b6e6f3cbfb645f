# While installing: the changelogs of a package, into `asdic_doc` below the prefix. Their date is SOURCE_DATE_EPOCH, or now.
set(folder "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/${asdic_doc}")
get_filename_component(package "${asdic_doc}" NAME)
file(MAKE_DIRECTORY "${folder}")
execute_process(COMMAND gzip -9nc "${asdic_source}/CHANGELOG.md" OUTPUT_FILE "${folder}/changelog.gz" COMMAND_ERROR_IS_FATAL ANY)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE "${folder}/changelog.Debian"
  "asdic (${asdic_version}) bookworm; urgency=medium\n\n  * What changed is told in changelog.gz.\n\n"
  " -- ${asdic_maintainer}  ${date}\n")
execute_process(COMMAND gzip -9nf "${folder}/changelog.Debian" COMMAND_ERROR_IS_FATAL ANY)
