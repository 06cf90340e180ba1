/// What the command line for browsers leaves out.
#include "build/build_arguments.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::cli {

void build_esvo_file(const BuildArguments& arguments, Session&) {
  throw Error(arguments.output, "", "the voxdag of browsers builds no ESVOs: it shows none");
}

void build_dag_in_parts(const BuildArguments& arguments, Session&) {
  throw Error(arguments.output, "", "the voxdag of browsers builds a DAG in one part");
}

}  // namespace voxdag::cli
