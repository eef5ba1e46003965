# shoal: build, test, install. `make help` lists the targets.
#
#   V=1           print the commands
#   WERROR=1      make warnings errors
#   SANITIZE=1    build and test with the address and undefined behaviour sanitizers, of gcc or with CC=clang of clang;
#                 SANITIZE=thread with that for threads, of clang. Each has a folder build-sanitize...
#   TEST="rod x"  let `make test` run tests/*/test_rod.c and tests/*/test_x.sh only
#   CC=clang      another compiler; CFLAGS, CPPFLAGS and LDFLAGS too are taken from here or from the environment
#   SUNDIALS_DIR=... and SUITESPARSE_DIR, NETCDF_DIR, LAPACKE_DIR, YAML_DIR, ZLIB_DIR
#                 the folder with include/ and lib/ of a library that is not found (scripts/find-libraries.sh)
#   TIME=600      seconds of `make fuzz`
#   LIST=1, ALL=1, NAME="demo gallery/swim"
#                 of `make figures`: say which are older than their inputs; draw all; draw these
#   WRITE=1       let `make numbers` replace output and tables that differ

VERSION   = 0.1.0
SOVERSION = 0

prefix = /usr/local
libdir = $(prefix)/lib
ifeq ($(origin CC),default)
CC = $(if $(shell command -v gcc),gcc,cc)
endif
PYTHON = /usr/bin/python3
TIME   = 600

CPPFLAGS ?=
CFLAGS   ?= -O3 -g
LDFLAGS  ?=

SHELL = /bin/bash
.SHELLFLAGS = -euo pipefail -c
.DELETE_ON_ERROR:
.SUFFIXES:
.DEFAULT_GOAL = all

ifdef V
quiet =
say = @:
else
quiet = @
say = @printf '  %-4s %s\n'
endif
quoted = '$(subst ','\'',$(1))'

# ---- compiler and flags

B = build
sanitize =
ifdef SANITIZE
CFLAGS = -O1 -g
ifeq ($(SANITIZE),thread)
# libgomp tells the sanitizer nothing of how threads wait for each other; with libomp Archer does (scripts/run-tests.sh)
CC = clang
B = build-sanitize-thread
sanitize = -fsanitize=thread
# tests with threads; `make test SANITIZE=thread TEST="..."` for others
TEST = parallel tree images flow flow_sources residual linear simulate shoal clearance sundials threads
else
# clang reports NULL + 0, which no compiler has ever taken for anything but NULL and the next C defines (N3322); gcc 12
# warns of possibly unset variables in code of the sanitizer
B = build-sanitize$(if $(is_clang),-clang)
sanitize = -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer \
           $(if $(is_clang),-fno-sanitize=pointer-overflow,-Wno-maybe-uninitialized)
endif
endif
is_clang := $(findstring clang,$(shell $(CC) --version 2>/dev/null))

# -iquote, not -I: <netcdf.h> is the library's header and "result/netcdf.h" is ours. _XOPEN_SOURCE=700 is POSIX 2008 with M_PI.
# The results must not depend on the machine: nothing that reorders sums or fuses operations belongs here.
shoal_cppflags = -D_XOPEN_SOURCE=700 -iquote src -iquote include $(file <$(B)/cppflags) $(CPPFLAGS)
# One set of objects serves the program and the shared library, which exports the names of include/shoal.h.
shoal_cflags = -std=c11 -ffp-contract=off -fno-math-errno -fopenmp -fPIC -fvisibility=hidden \
               -Wall -Wextra -Wconversion -Wshadow -Wcast-qual $(if $(WERROR),-Werror) $(warnings) $(sanitize) $(CFLAGS) \
               $(if $(gcc_12_arm64),-fvect-cost-model=very-cheap)
# clang, unlike gcc, warns of fields left out of an initialiser with a name, and of the empty format of an empty cell
warnings = $(if $(is_clang),-Wno-missing-field-initializers -Wno-format-zero-length)
# gcc 12 for arm64 stops with an internal error (vect_transform_reduction) at loops that the cost model of -O3 vectorises
gcc_12_arm64 := $(if $(is_clang),,$(filter aarch64%-12,$(shell $(CC) -dumpmachine)-$(firstword $(subst ., ,$(shell $(CC) -dumpversion)))))
# results of scripts/find-libraries.sh
libraries = $(file <$(B)/libraries) -lm
# OpenMP as a part of the program, if the compiler supports this: src/app/main.c. Clang has another OpenMP library.
static_gomp = $(if $(is_clang),,$(wildcard $(shell $(CC) -print-file-name=libgomp.a)))
# the shared library has no undefined names, except names of a sanitizer, which the program has
complete = $(if $(sanitize),,-Wl,-z,defs)

# ---- files

# objects.a holds every function for the program and the tests; libshoal, which is installed, shares shoal_* only
objects = $(B)/objects.a
library = $(B)/libshoal.a
soname  = libshoal.so.$(SOVERSION)
shared  = $(B)/$(soname)
program = $(B)/shoal

# the rooms of src/, lowest first: scripts/check-layers.sh
rooms           = base fish body wake control state flow force contact school case solver result view run steady study library app
folders         = $(addprefix $(B)/,doc verify bench fuzz $(rooms) $(patsubst %,tests/%,$(rooms) extra))
app_objects     = $(patsubst src/%.c,$(B)/%.o,$(wildcard src/app/*.c))
library_objects = $(patsubst src/%.c,$(B)/%.o,$(wildcard $(patsubst %,src/%/*.c,$(filter-out app,$(rooms)))))
c_files         = $(wildcard src/*/*.[ch] include/*.h tests/*.[ch] tests/*/*.[ch])

# tests/extra needs further packages or minutes, and tests/slurm a cluster: they belong to make test-all, or are named
# with TEST; with the sanitizers make test runs all tests in C
test_names   = $(or $(TEST),*)
c_tests      = $(patsubst tests/%.c,$(B)/tests/%,$(wildcard $(test_names:%=tests/*/test_%.c)))
shell_tests  = $(filter-out $(if $(TEST),,tests/extra/%) tests/slurm/%,$(wildcard $(test_names:%=tests/*/test_%.sh)))
extra_c_tests = $(filter $(B)/tests/extra/%,$(c_tests))
extra_tests  = $(extra_c_tests) $(wildcard $(test_names:%=tests/extra/test_%.sh))
usual_c_tests = $(filter-out $(if $(TEST)$(sanitize),,$(extra_c_tests)),$(c_tests))
# those that take longest begin, so that all processors have work to the end; then the other scripts
longest      = python error branch steady_formation study command resume results steady_command threshold_command cases
first_tests  = $(foreach test,$(longest),$(filter %/test_$(test) %/test_$(test).sh,$(c_tests) $(shell_tests)))
# C tests of more than three seconds, not in make check
long_c_tests  = contact diagnostics diagnostics_momentum flow_at_markers flow_sources sensor_pressure simulate steady steady_formation take_up tree warnings
quick_c_tests = $(filter-out $(foreach test,$(long_c_tests),%/test_$(test)),$(usual_c_tests))
test_helpers  = $(patsubst tests/%.c,$(B)/tests/%.o,$(wildcard tests/*.c))

verify_program = $(B)/verify/verify
bench_programs = $(patsubst tests/bench/%.c,$(B)/bench/%,$(wildcard tests/bench/*.c))
fuzz_programs  = $(addprefix $(B)/fuzz/,fuzz_case fuzz_result fuzz_checkpoint)
# libraries to be preloaded, which make system calls and allocations fail
faults         = $(B)/files.so $(B)/memory.so

generated_docs = $(addprefix $(B)/doc/,cases.md output.md case.schema.json)
manual         = $(addprefix $(B)/doc/,shoal.1 shoal-case.5 shoal-output.5)
completion     = $(B)/doc/completion

# ---- targets

# make again, on all cores unless told otherwise
parallel = $(MAKE) --no-print-directory $(if $(filter -j%,$(MAKEFLAGS)),,-j$(shell nproc))

.PHONY: all tests demo clean help deps test test-extra test-all check test-c test-slurm test-platforms valgrind verify soak fuzz \
        fuzz-programs mutants bench style format docs numbers figures site install uninstall deb FORCE

## Build

all: $(program) $(library) $(shared)  ## build build/shoal, build/libshoal.a and build/libshoal.so.0

demo: deps  ## install what is missing, build, swim: demo.nc, demo.png and demo.html
	@$(parallel) all
	@$(program) demo --force

deps:  ## install the packages that are missing (nothing to do: no output)
	@scripts/install-deps.sh

clean:  ## remove everything that was built
	$(quiet)rm -rf build build-sanitize build-sanitize-clang build-sanitize-thread build-fuzzer

help:  ## this list
	@awk -F '  +## ' '/^## / { print "\n" substr($$0, 4) } \
	    /^[a-z-]+:.*  ## / { sub(/:.*/, "", $$1); printf "  make %-15s %s\n", $$1, $$2 }' Makefile
	@printf '\nVariables\n'; sed -n 's/^#   \([A-Z]\)/  \1/p' Makefile

## Test

test: deps  ## install what is missing, build, test the program (minutes)
	@$(parallel) tests
	@scripts/run-tests.sh $(program) $(first_tests) $(filter-out $(first_tests),$(shell_tests) $(usual_c_tests))

test-extra: deps  ## test each key, documents, studies, the article, figures, site, pages in a browser, files of VTK, manual, packages, faults, classical results
	@scripts/install-deps.sh @extra @site
	@$(parallel) tests
	@scripts/run-tests.sh $(program) $(extra_tests)

test-all:  ## all of it: make test and test-extra, Slurm, and the tests in C on Debian 13 (as root; half an hour)
	@for target in test test-extra test-slurm; do $(MAKE) --no-print-directory $$target; done
	@scripts/platforms.sh debian13-gcc:c_tests

check: deps style  ## what to run before a commit: style, and the tests in C that take at most three seconds
	@$(parallel) tests
	@scripts/run-tests.sh $(program) $(quick_c_tests)

test-c: deps  ## run the tests in C only, those of tests/extra too (a minute)
	@$(parallel) tests
	@scripts/run-tests.sh $(program) $(c_tests)

test-slurm: deps  ## install Slurm where it is missing, start it, run a study on it, stop it (as root)
	@scripts/install-deps.sh @slurm
	@$(parallel) all
	@tests/slurm/test_slurm.sh $(program)

test-platforms: all  ## build and test on other systems in chroots, as root: Debian 12 and 13, gcc and clang, arm64 (hours)
	@scripts/platforms.sh $(if $(PLATFORMS),,--write doc/install.md) $(PLATFORMS)

verify: deps  ## check the program against classical results (minutes): build/verify/report.md with figures
	@$(parallel) $(verify_program)
	@scripts/verify.sh $(verify_program) $(B)/verify doc/verification.md

valgrind: deps  ## let valgrind watch the tests in C (TEST="..."), and a run of the program (an hour)
	@scripts/install-deps.sh valgrind
	@$(parallel) tests
	@scripts/valgrind.sh $(program) $(c_tests)

soak: deps  ## let everything fail that can: all of tests/soak (an hour)
	@$(parallel) all $(faults)
	@TIME_LIMIT=14400 scripts/run-tests.sh $(program) $(filter-out %/common.py,$(wildcard tests/soak/*.sh tests/soak/*.py))

fuzz: deps  ## mutate cases, results and checkpoints for TIME seconds, with the sanitizers
	@scripts/fuzz.sh $(TIME)

mutants: deps  ## see that the tests notice errors: 200 small ones are built in, one at a time (minutes)
	@$(parallel) tests
	@scripts/mutants.py

style: WERROR = 1
style: all $(generated_docs)  ## check warnings, format, layers, names and the generated documents
	@! cat $(wildcard $(B)/*/*.warnings $(B)/tests/*/*.warnings) | grep .
	@clang-format --dry-run -Werror $(c_files)
	@scripts/check-layers.sh $(B)
	@scripts/check-names.sh $(B)
	@scripts/mutants.py --check
	@scripts/check-docs.py
	@for document in $(generated_docs:$(B)/%=%); do \
	    diff -u "$$document" "$(B)/$$document" || { echo "$$document is out of date: run 'make docs'" >&2; exit 1; }; \
	done

format:  ## lay out all C files as `make style` wants them
	$(quiet)clang-format -i $(c_files)

## Measure and document

bench: $(program) $(bench_programs)  ## measure: inner loops, phases, schools, whole runs (doc/performance.md)
	@scripts/bench.sh $(B)

docs: $(generated_docs)  ## write cases.md, output.md and case.schema.json in doc from the tables of the program
	$(quiet)cp $^ doc/

numbers: deps  ## list output and tables of README.md and doc/*.md that differ from the program (an hour); WRITE=1: replace
	@scripts/install-deps.sh python3-scipy
	@$(parallel) all
	@code=0; scripts/documents.py $(if $(WRITE),--write) README.md doc/*.md || code=1; \
	scripts/notebook.py $(if $(WRITE),,--check) || code=1; \
	for script in $(filter-out %/tables.py,$(wildcard scripts/measure/*.py)); do \
	    $$script $(if $(WRITE),--write,--compare) || code=1; \
	done; exit $$code

figures: deps  ## draw the figures of the documents that are older than case, script or results (LIST=1: say which; ALL=1; NAME=...)
	@scripts/install-deps.sh python3-pil ffmpeg
	@$(parallel) all
	@scripts/figures.py $(if $(LIST),--list) $(if $(ALL),--all) $(NAME)

site: deps  ## make the documentation site, build/site/html/index.html: the documents, the API of Python and C, search
	@scripts/install-deps.sh @site
	@$(parallel) all
	@scripts/site/make-site.sh $(B)/site $(VERSION)

## Install: prefix=/usr/local libdir=$prefix/lib DESTDIR=

install_settings = B=$(B) VERSION=$(VERSION) SOVERSION=$(SOVERSION) PYTHON=$(PYTHON) \
    DESTDIR=$(call quoted,$(DESTDIR)) prefix=$(call quoted,$(prefix)) libdir=$(call quoted,$(libdir)) \
    private_libraries=$(call quoted,$(libraries) $(if $(is_clang),$(shell $(CC) -print-file-name=libomp.so),-fopenmp))

install: all $(manual) $(completion)  ## install program, library, header, module, cases, scripts, documents
	$(say) INST $(call quoted,$(DESTDIR)$(prefix))
	$(quiet)$(install_settings) scripts/packaging/install.sh

uninstall:  ## remove what `make install` installed
	$(quiet)$(install_settings) scripts/packaging/install.sh --remove

deb: deps  ## build the packages of Debian in build/deb, and let lintian check them
	@scripts/install-deps.sh @deb
	@scripts/packaging/make-deb.sh $(B)/deb $(VERSION)

# ---- rules

define link
$(say) LD $@
$(quiet)$(CC) $(shoal_cflags) $(LDFLAGS) -o $@ $^ $(link_flags) $(libraries)
endef

define archive
$(say) AR $@
$(quiet)rm -f $@
$(quiet)$(AR) rcs $@ $^
endef

# warnings are kept for `make style`
define compile
$(say) CC $<
$(quiet)$(CC) $(shoal_cppflags) $(shoal_cflags) -MMD -MP -c -o $@ $< 2> >(tee $(@:.o=.warnings) >&2)
endef

# the programs of tests/bench, fuzz and verify are built in folders of these names
$(B)/%.o: src/%.c Makefile $(B)/libraries | $(folders)
	$(compile)
$(B)/%.o: tests/%.c Makefile $(B)/libraries | $(folders)
	$(compile)
$(B)/tests/%.o: shoal_cppflags += -iquote tests
$(B)/tests/%.o: tests/%.c Makefile $(B)/libraries | $(folders)
	$(compile)

$(program): link_flags = $(static_gomp)
$(program): $(app_objects) $(objects)
	$(link)

$(objects): $(library_objects)
	$(archive)

# one object in which every other name is local: a program that links it may use those names for itself
$(B)/libshoal.o: $(library_objects)
	$(say) LD $@
	$(quiet)$(LD) -r -o $@ $^
	$(quiet)objcopy --wildcard --keep-global-symbol='shoal_*' $@

$(library): $(B)/libshoal.o
	$(archive)

$(shared): src/library/shoal.map
$(shared): link_flags = -shared -Wl,-soname,$(soname) -Wl,--version-script=src/library/shoal.map $(complete)
$(shared): $(library_objects)
	$(say) LD $@
	$(quiet)$(CC) $(shoal_cflags) $(LDFLAGS) $(link_flags) -o $@ $(library_objects) $(libraries)

tests: all $(faults) $(fuzz_programs) $(c_tests) $(verify_program) $(bench_programs)

# A program that defines __wrap_calloc receives every calloc of the library, and finds the true one as __real_calloc.
wrapped = $$(nm $(filter %.o,$^) | sed -n 's/.* T __wrap_\(.*\)/-Wl,--wrap=\1/p')

$(c_tests): link_flags = $(wrapped) -lcmocka
$(c_tests): %: %.o $(test_helpers) $(objects)
	$(link)

$(bench_programs): link_flags = $(wrapped)
$(bench_programs): %: %.o $(objects)
	$(link)

$(verify_program): $(patsubst tests/verify/%.c,$(B)/verify/%.o,$(wildcard tests/verify/*.c)) $(objects)
	$(link)

# scripts/fuzz.sh replaces the driver by that of libFuzzer
fuzz_driver = $(B)/fuzz/driver.o
fuzz_flags  =
fuzz-programs: $(program) $(fuzz_programs)
$(fuzz_programs): link_flags = $(fuzz_flags)
$(fuzz_programs): %: %.o $(fuzz_driver) $(objects)
	$(link)

$(faults): $(B)/%.so: tests/faults/%.c Makefile | $(folders)
	$(say) LD $@
	$(quiet)$(CC) -std=c11 -Wall -Wextra -Wconversion -Wshadow -Wcast-qual $(if $(WERROR),-Werror) -O2 -shared -fPIC -o $@ $<

# what the program tells of itself, as a document
$(B)/doc/cases.md:         describe = $(program) keys --json | $(PYTHON) scripts/make-cases-doc.py
$(B)/doc/output.md:        describe = $(program) keys --output --json | $(PYTHON) scripts/make-output-doc.py
$(B)/doc/case.schema.json: describe = $(program) keys --json | $(PYTHON) scripts/make-schema.py
$(B)/doc/shoal.1:          describe = $(program) --describe | $(PYTHON) scripts/make-man.py shoal.1
$(B)/doc/shoal-case.5:     describe = $(program) keys --json | $(PYTHON) scripts/make-man.py shoal-case.5
$(B)/doc/shoal-output.5:   describe = $(program) keys --output --json | $(PYTHON) scripts/make-man.py shoal-output.5
$(completion):             describe = $(PYTHON) scripts/make-completion.py <($(program) --describe) <($(program) keys --json)
$(generated_docs) $(manual) $(completion): $(program) $(wildcard scripts/make-*.py) | $(folders)
	$(quiet)$(describe) >$@

$(B)/view/page.o: src/view/page.html
$(B)/view/page.o: shoal_cflags += -Wa,-I$(abspath src/view)

# "commit" or "commit-dirty" of the repository of this folder, not of a surrounding one; rewritten only when it changes
commit := $(shell test -e .git && git describe --always --dirty --abbrev=12 --exclude='*' 2>/dev/null || echo unknown)
$(B)/commit: FORCE | $(folders)
	@echo '$(commit)' | cmp -s - $@ || echo '$(commit)' >$@
$(B)/base/version.o: shoal_cppflags += -DSHOAL_VERSION='"$(VERSION)"' -DSHOAL_COMMIT='"$(commit)"'
$(B)/base/version.o: $(B)/commit

# libraries are looked for again when the compiler or one of these variables is another one
library_variables = CC CPPFLAGS LDFLAGS PKG_CONFIG_PATH CONDA_PREFIX $(addsuffix _DIR,SUNDIALS SUITESPARSE NETCDF LAPACKE YAML ZLIB)
configuration = $(foreach variable,$(library_variables),$(variable)='$(filter-out ccache,$($(variable)))')
$(B)/configuration: FORCE | $(folders)
	@echo "$(configuration)" | cmp -s - $@ || echo "$(configuration)" >$@
$(B)/libraries: $(B)/configuration scripts/find-libraries.sh
	$(say) FIND '$(B)/libraries'
	$(quiet)$(configuration) scripts/find-libraries.sh $(B) $(CC)

$(folders):
	@mkdir -p $@

-include $(wildcard $(B)/*/*.d $(B)/tests/*/*.d)
