#!/usr/bin/env bash
# Find the libraries of shoal: compiler and linker flags.
#
#   scripts/find-libraries.sh FOLDER COMPILER...    write FOLDER/cppflags, FOLDER/libraries and FOLDER/libraries.log
#
# A library is found where a small program that uses it compiles and links. If SUNDIALS_DIR, SUITESPARSE_DIR, NETCDF_DIR,
# LAPACKE_DIR, YAML_DIR or ZLIB_DIR names a folder, its library is looked for there and nowhere else. Otherwise the script
# tries what pkg-config says, the environment of conda, the prefix of Homebrew, the places where the compiler looks by
# itself, and /usr/local. CPPFLAGS and LDFLAGS apply. For a missing library it prints one line with the names of the packages.
set -euo pipefail

folder=${1:?usage: scripts/find-libraries.sh FOLDER COMPILER...}
shift
readonly compiler=("$@") log=$folder/libraries.log
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
: >"$log"
cppflags=() libraries=() n_missing=0

# Whether $program compiles and links with these flags.
links() {  # flags...
    printf '%s\n' "$program" >"$work/try.c"
    # shellcheck disable=SC2086 # CPPFLAGS and LDFLAGS are lists of flags
    set -- "${compiler[@]}" -std=c11 ${CPPFLAGS-} "${cppflags[@]}" ${LDFLAGS-} -o "$work/try" "$work/try.c" "$@" -lm
    echo "+ $*" >>"$log"
    "$@" >>"$log" 2>&1
}

# Flags for a prefix, with headers possibly in a subfolder.
flags_of() {  # prefix, folder of headers
    local lib
    for lib in "$1/lib64" "$1/lib"; do
        [[ ! -d $lib ]] || echo "-isystem $1/include${2:+ -isystem $1/include/$2} -L$lib -Wl,-rpath,$lib"
    done
}

# Flags from pkg-config; headers as system headers, without their warnings.
packaged_flags() {  # name
    ${PKG_CONFIG:-pkg-config} --cflags --libs "$1" 2>>"$log" | sed -E 's/(^| )-I *([^ ]*)/\1-isystem \2/g' || true
}

# Flags that may find a library, a line for each place.
places() {  # folder of the library, folder of headers, name for pkg-config
    local brew
    if [[ -n $1 ]]; then
        flags_of "$1" "$2"
        return
    fi
    [[ -z $3 ]] || packaged_flags "$3"
    [[ -z ${CONDA_PREFIX-} ]] || flags_of "$CONDA_PREFIX" "$2"
    if brew=$(brew --prefix 2>/dev/null); then
        flags_of "$brew" "$2"
        flags_of "$brew/opt/lapack" ''
    fi
    echo "${2:+-isystem /usr/include/$2}"
    flags_of /usr/local "$2"
}

# Divide flags into flags of the preprocessor and flags of the linker.
keep() {  # flags...
    while (($# > 0)); do
        case $1 in
            -isystem) cppflags+=("$1" "$2") && shift ;;
            -I* | -D*) cppflags+=("$1") ;;
            *) libraries+=("$1") ;;
        esac
        shift
    done
}

# Find one library and keep the flags; $program uses the library. Each line of the last argument is a choice of link flags.
find_library() {  # title, packages, variable with the folder, folder of headers, name for pkg-config, libraries
    local place own
    while read -r place; do
        while read -r own; do
            [[ $place != *-l* ]] || own=''  # pkg-config names the libraries too
            # shellcheck disable=SC2086 # lists of flags
            if links $place $own; then
                keep $place $own
                return
            fi
        done <<<"$6"
    done < <(places "${!3-}" "$4" "$5")
    n_missing=$((n_missing + 1))
    echo "missing: $1 ($2; or set $3 to its folder; what was tried: $log)" >&2
}

# The names of a package for Debian, Fedora, Homebrew and conda.
packages() {
    echo "Debian: $1, Fedora: $2, Homebrew: $3, conda: $4"
}

program='int main(void) { return 0; }'
if ! links; then
    echo "missing: a C compiler, '${compiler[*]}' does not work ($(packages gcc gcc gcc c-compiler); or set CC; what was tried: $log)" >&2
    exit 1
fi
program='#include <omp.h>
int main(void) { return omp_get_max_threads() == 0; }'
if ! links -fopenmp; then
    echo "missing: OpenMP for '${compiler[*]}' ($(packages libomp-dev libomp-devel libomp llvm-openmp); what was tried: $log)" >&2
    exit 1
fi

# the headers of SUNDIALS may include <mpi.h> in any case
mapfile -t mpi < <(echo; for name in mpi-c ompi-c mpich; do packaged_flags $name; done
    { mpicc -showme:compile && mpicc -showme:link; } 2>>"$log" | tr '\n' ' ' || true)
# those that a version or a distribution may lack: the vectors of OpenMP, and the core, which was in all others before 7
sundials='-lsundials_ida -lsundials_kinsol -lsundials_arkode -lsundials_sunlinsolspgmr -lsundials_nvecserial'
optional=('-lsundials_nvecopenmp -lsundials_core' -lsundials_nvecopenmp -lsundials_core '')
program='#include <arkode/arkode_arkstep.h>
#include <ida/ida.h>
#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#if __has_include(<nvector/nvector_openmp.h>)
#include <nvector/nvector_openmp.h>
#endif
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#if SUNDIALS_VERSION_MAJOR < 6 || (SUNDIALS_VERSION_MAJOR == 6 && SUNDIALS_VERSION_MINOR < 4)
#error "SUNDIALS is too old"
#elif SUNDIALS_VERSION_MAJOR == 6
#define SUN_COMM_NULL 0
#endif
int main(void) {
    SUNContext context;
    SUNContext_Create(SUN_COMM_NULL, &context);
    N_Vector vector = N_VNew_Serial(1, context);
#if __has_include(<nvector/nvector_openmp.h>)
    vector = N_VNew_OpenMP(1, 1, context);
#endif
    return !SUNLinSol_SPGMR(vector, SUN_PREC_NONE, 1, context) || !IDACreate(context) || !KINCreate(context) ||
           !ARKStepCreate(0, 0, 0, 0, context);
}'
find_library 'SUNDIALS 6.4 or later' "$(packages libsundials-dev sundials-devel sundials sundials)" SUNDIALS_DIR '' '' \
    "$(for one in "${mpi[@]}"; do for more in "${optional[@]}"; do echo "$sundials $more $one"; done; done)"

program='#include <klu.h>
#if SUITESPARSE_MAIN_VERSION < 5
#error "SuiteSparse is too old"
#endif
int main(void) {
    klu_l_common common;
    int version[3];
    SuiteSparse_version(version);
    return klu_l_defaults(&common);
}'
find_library 'SuiteSparse 5 or later' "$(packages libsuitesparse-dev suitesparse-devel suite-sparse suitesparse)" \
    SUITESPARSE_DIR suitesparse '' '-lklu -lamd -lcolamd -lbtf -lsuitesparseconfig'

program='#include <lapacke.h>
int main(void) {
    lapack_int a, b, c;
    LAPACKE_ilaver(&a, &b, &c);
    return a == 0;
}'
find_library LAPACKE "$(packages 'liblapacke-dev liblapack-dev libblas-dev' lapack-devel lapack liblapacke)" LAPACKE_DIR \
    lapacke lapacke $'-llapacke -llapack -lblas\n-llapacke\n-lopenblas'

program='#include <netcdf.h>
#include <netcdf_meta.h>
#if NC_VERSION_MAJOR < 4 || (NC_VERSION_MAJOR == 4 && NC_VERSION_MINOR < 9)
#error "NetCDF is too old"
#endif
int main(void) { return nc_inq_libvers()[0] == 0; }'
find_library 'NetCDF 4.9 or later' "$(packages libnetcdf-dev netcdf-devel netcdf libnetcdf)" NETCDF_DIR '' netcdf -lnetcdf

program='#include <yaml.h>
int main(void) { return yaml_get_version_string()[0] == 0; }'
find_library libyaml "$(packages libyaml-dev libyaml-devel libyaml yaml)" YAML_DIR '' yaml-0.1 -lyaml

program='#include <zlib.h>
int main(void) { return zlibVersion()[0] == 0; }'
find_library zlib "$(packages zlib1g-dev zlib-devel zlib zlib)" ZLIB_DIR '' zlib -lz

((n_missing == 0)) || exit 1
# no newline: make 4.3 does not always remove the newline
printf %s "${cppflags[*]}" >"$folder/cppflags"
printf %s "${libraries[*]}" >"$folder/libraries"
