/// The command line for browsers refuses what it does not have: ESVOs, and builds in parts.
#include "build/build_arguments.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::cli {

void build_esvo_file(const BuildArguments& arguments, Session&) {
  throw Error(arguments.output, "", "is an ESVO, which the voxdag of browsers does not build");
}

void build_dag_in_parts(const BuildArguments& arguments, Session&) {
  throw Error(arguments.output, "", "the voxdag of browsers builds a DAG in one part");
}

}  // namespace voxdag::cli
