# shoal: build, test, install. `make help` lists the targets.
#
#   V=1           print the commands
#   SANITIZE=1    build and test with the address and undefined behaviour sanitizers, of gcc or with CC=clang of clang;
#                 SANITIZE=thread with that for threads, of clang. Each has a folder build-sanitize...
#   TIME=600      seconds of `make fuzz`
#   WERROR=1      make warnings errors
#   CC=clang      another compiler; CFLAGS, CPPFLAGS and LDFLAGS too are taken from here or from the environment
#   SUNDIALS_DIR=... and SUITESPARSE_DIR, NETCDF_DIR, LAPACKE_DIR, YAML_DIR, ZLIB_DIR
#                 the folder with include/ and lib/ of a library that is not found (scripts/find-libraries.sh)
#   LIST=1, ALL=1, NAME="demo gallery/swim"
#                 of `make figures`: say which are older than their inputs; draw all; draw these
#   WRITE=1       let `make numbers` replace output and tables that differ
#   TEST="rod x"  let `make test` run tests/*/test_rod.c and tests/*/test_x.sh only

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

ifdef SANITIZE
CFLAGS = -O1 -g
ifeq ($(SANITIZE),thread)
# libgomp tells the sanitizer nothing of how threads wait for each other; with libomp Archer does (scripts/run-tests.sh)
CC = clang
B = build-sanitize-thread
sanitize = -fsanitize=thread
# flags for threads; `make test SANITIZE=thread TEST="..."` for other tests
TEST = parallel tree images flow flow_sources residual linear simulate shoal clearance sundials threads
else
B = build-sanitize$(if $(is_clang),-clang)
# gcc 12 warns of possibly unset variables in code of the sanitizer
sanitize = -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer \
           $(if $(is_clang),$(null_plus_0),-Wno-maybe-uninitialized)
endif
else
B = build
sanitize =
# the shared library has no undefined names, except names of a sanitizer, which the program has
complete = -Wl,-z,defs
endif

# clang reports NULL + 0, which no compiler has ever taken for anything but NULL and the next C defines (N3322)
null_plus_0 = -fno-sanitize=pointer-overflow

# set by `make fuzz`: all for libFuzzer, whose main replaces the main of the driver
clang = $(shell command -v clang)
ifdef FUZZER
B = build-fuzzer
sanitize = -fsanitize=address,undefined,fuzzer-no-link -fno-sanitize-recover=all -fno-omit-frame-pointer $(null_plus_0)
endif
is_clang := $(findstring clang,$(shell $(CC) --version 2>/dev/null))

ifdef V
quiet =
say = @:
else
quiet = @
say = @printf '  %-4s %s\n'
endif

# -iquote, not -I: <netcdf.h> is the library's header and "result/netcdf.h" is ours. _XOPEN_SOURCE=700 is POSIX 2008 with M_PI.
# The results must not depend on the machine: nothing that reorders sums or fuses operations belongs here.
shoal_cppflags = -D_XOPEN_SOURCE=700 -iquote src -iquote include $(file <$(B)/cppflags) $(CPPFLAGS)
# One set of objects serves the program and the shared library, which exports the names of include/shoal.h.
shoal_cflags   = -std=c11 -ffp-contract=off -fno-math-errno -fopenmp -fPIC -fvisibility=hidden \
                 -Wall -Wextra -Wconversion -Wshadow -Wcast-qual $(if $(WERROR),-Werror) $(warnings) $(sanitize) $(CFLAGS) \
                 $(if $(gcc_12_arm64),-fvect-cost-model=very-cheap)
# clang, unlike gcc, warns of fields left out of an initialiser with a name, and of the empty format of an empty cell
warnings = $(if $(is_clang),-Wno-missing-field-initializers -Wno-format-zero-length)
# gcc 12 for arm64 stops with an internal error (vect_transform_reduction) at loops that the cost model of -O3 vectorises
gcc_12_arm64 := $(if $(is_clang),,$(filter aarch64%-12,$(shell $(CC) -dumpmachine)-$(firstword $(subst ., ,$(shell $(CC) -dumpversion)))))
# results of scripts/find-libraries.sh
libraries      = $(file <$(B)/libraries) -lm

# OpenMP as a part of the program, if the compiler supports this: src/app/main.c. Clang has another OpenMP library.
static_gomp = $(if $(is_clang),,$(wildcard $(shell $(CC) -print-file-name=libgomp.a)))

# objects.a holds every function for the program and the tests; libshoal, which is installed, shares shoal_* only
objects = $(B)/objects.a
library = $(B)/libshoal.a
soname  = libshoal.so.$(SOVERSION)
shared  = $(B)/$(soname)
program = $(B)/shoal

# the rooms of src/, lowest first: scripts/check-layers.sh
rooms           = base fish body wake control state flow force contact school case solver result view run steady study library app
folders         = $(addprefix $(B)/,doc verify bench fuzz $(rooms) $(rooms:%=tests/%))
app_objects     = $(patsubst src/%.c,$(B)/%.o,$(wildcard src/app/*.c))
library_objects = $(patsubst src/%.c,$(B)/%.o,$(wildcard $(patsubst %,src/%/*.c,$(filter-out app,$(rooms)))))

test_names   = $(or $(TEST),*)
c_tests      = $(patsubst tests/%.c,$(B)/tests/%,$(wildcard $(test_names:%=tests/*/test_%.c)))
# tests/extra needs further packages or minutes, and tests/slurm a cluster: they belong to make test-all, or are named
# with TEST
shell_tests  = $(filter-out $(if $(TEST),,tests/extra/%) tests/slurm/%,$(wildcard $(test_names:%=tests/*/test_%.sh)))
extra_tests  = $(wildcard $(test_names:%=tests/extra/test_%.sh))
# C tests of more than three seconds, not in make check
long_c_tests = contact diagnostics diagnostics_momentum estimate flow_at_markers flow_sources sensor_pressure simulate steady steady_formation take_up tree warnings
quick_c_tests = $(filter-out $(foreach test,$(long_c_tests),%/test_$(test)),$(c_tests))
test_helpers = $(patsubst tests/%.c,$(B)/tests/%.o,$(wildcard tests/*.c))

verify_program = $(B)/verify/verify
verify_objects = $(patsubst tests/verify/%.c,$(B)/verify/%.o,$(wildcard tests/verify/*.c))

bench_programs = $(patsubst tests/bench/%.c,$(B)/bench/%,$(wildcard tests/bench/*.c))

fuzz_programs  = $(B)/fuzz/fuzz_case $(B)/fuzz/fuzz_result $(B)/fuzz/fuzz_checkpoint

generated_docs = $(B)/doc/cases.md $(B)/doc/output.md $(B)/doc/case.schema.json
manual         = $(B)/doc/shoal.1 $(B)/doc/shoal-case.5 $(B)/doc/shoal-output.5
completion     = $(B)/doc/completion
c_files        = $(wildcard src/*/*.[ch] include/*.h tests/*.[ch] tests/*/*.[ch])

# packages of `make test-extra`: a browser, readers of VTK's files, of schemas, of manual pages, and pip
extra_packages = chromium python3-vtk9 python3-jsonschema python3-yaml groff mandoc man-db bsdextrautils python3-pip python3-venv python3-setuptools python3-wheel $(site_packages)

# packages of `make site`
site_packages = python3-sphinx python3-myst-parser furo doxygen python3-breathe jupyter-nbconvert python3-ipykernel

# "commit" or "commit-dirty" of the repository of this folder, not of a surrounding repository
commit := $(shell test -e .git && git describe --always --dirty --abbrev=12 --exclude='*' 2>/dev/null || echo unknown)

# the folder under the prefix in which $(PYTHON) looks for modules; else one for PYTHONPATH
python_modules = $(shell $(PYTHON) -c 'import site, sys; \
    folders = [f for f in [*sys.path, site.getusersitepackages()] if f.startswith("$(prefix)/lib") and f.endswith("-packages")]; \
    print((folders + ["$(prefix)/lib/python%d.%d/site-packages" % sys.version_info[:2]])[0])')

# make again, on all cores unless told otherwise
parallel = $(MAKE) --no-print-directory $(if $(filter -j%,$(MAKEFLAGS)),,-j$(shell nproc))

.PHONY: all demo deb check test test-extra test-all test-c test-platforms test-slurm tests valgrind verify numbers figures site soak fuzz fuzz-programs mutants bench style format docs install uninstall clean deps help FORCE

## Everyday

all: $(program) $(library) $(shared)  ## build build/shoal, build/libshoal.a and build/libshoal.so.0

demo: deps  ## install what is missing, build, swim: demo.nc, demo.png and demo.html
	@$(parallel) all
	@$(program) demo --force

test: deps  ## install what is missing, build, test the program (minutes)
	@$(parallel) tests
	@scripts/run-tests.sh $(program) $(c_tests) $(shell_tests)

test-extra: deps  ## test documents, studies, the article, figures, site, pages in a browser, files of VTK, manual, packages, faults, classical results
	@scripts/install-deps.sh $(extra_packages)
	@$(parallel) tests
	@scripts/run-tests.sh $(program) $(extra_tests)

test-all:  ## all of it: make test and test-extra, Slurm, and the tests in C on Debian 13 (as root; half an hour)
	@$(MAKE) --no-print-directory test
	@$(MAKE) --no-print-directory test-extra
	@$(MAKE) --no-print-directory test-slurm
	@scripts/platforms.sh debian13-gcc:c_tests

check: deps style  ## what to run before a commit: style, and the tests in C that take at most three seconds
	@$(parallel) tests
	@scripts/run-tests.sh $(program) $(quick_c_tests)

test-c: deps  ## run the tests in C only (a minute)
	@$(parallel) tests
	@scripts/run-tests.sh $(program) $(c_tests)

test-platforms:  ## build and test on other systems in chroots, as root: Debian 12 and 13, gcc and clang, arm64 (hours)
	@$(parallel) all
	@scripts/platforms.sh $(if $(PLATFORMS),,--write doc/install.md) $(PLATFORMS)

test-slurm: deps  ## install Slurm where it is missing, start it, run a study on it, stop it (as root)
	@scripts/install-deps.sh slurm-wlm munge
	@$(parallel) all
	@tests/slurm/test_slurm.sh $(program)

verify: deps  ## check the program against classical results (minutes): build/verify/report.md with figures
	@$(parallel) $(verify_program)
	@scripts/verify.sh $(verify_program) $(B)/verify doc/verification.md

numbers: deps  ## list output and tables of README.md and doc/*.md that differ from the program (an hour); WRITE=1: replace
	@$(parallel) all
	@code=0; scripts/documents.py $(if $(WRITE),--write) README.md doc/*.md || code=1; \
	for script in $(filter-out %/tables.py,$(wildcard scripts/measure/*.py)); do \
	    $$script $(if $(WRITE),--write,--compare) || code=1; \
	done; exit $$code

figures: deps  ## draw the figures of the documents that are older than case, script or results (LIST=1: say which; ALL=1; NAME=...)
	@scripts/install-deps.sh python3-pil
	@$(parallel) all
	@scripts/figures.py $(if $(LIST),--list) $(if $(ALL),--all) $(NAME)

site: deps  ## make the documentation site, build/site/html/index.html: the documents, the API of Python and C, search
	@scripts/install-deps.sh $(site_packages)
	@$(parallel) all
	@scripts/site/make-site.sh $(B)/site $(VERSION)

valgrind: deps  ## let valgrind watch the tests in C (TEST="..."), and a run of the program (an hour)
	@scripts/install-deps.sh valgrind
	@$(parallel) tests
	@scripts/valgrind.sh $(program) $(c_tests)

soak: deps  ## let everything fail that can: all of tests/soak (an hour)
	@$(parallel) all $(faults)
	@TIME_LIMIT=14400 scripts/run-tests.sh $(program) $(filter-out %/common.py,$(wildcard tests/soak/*.sh tests/soak/*.py))

fuzz: deps  ## mutate cases, results and checkpoints for TIME seconds, with the sanitizers
	@$(parallel) SANITIZE=1 $(if $(clang),FUZZER=1 CC=clang) fuzz-programs
	@scripts/fuzz.sh $(if $(clang),build-fuzzer,build-sanitize) $(TIME)

fuzz-programs: $(program) $(fuzz_programs)

bench: $(program) $(bench_programs)  ## measure: inner loops, phases, schools, whole runs (doc/performance.md)
	@scripts/bench.sh $(B)

clean:  ## remove everything that was built
	$(quiet)rm -rf build build-sanitize build-sanitize-clang build-sanitize-thread build-fuzzer

help:  ## this list
	@awk -F '  +## ' '/^## / { print "\n" substr($$0, 4) } \
	    /^[a-z_.-]+:.*  ## / { sub(/:.*/, "", $$1); printf "  make %-15s %s\n", $$1, $$2 }' Makefile
	@printf '\nVariables\n'; sed -n 's/^#   \([A-Z]\)/  \1/p' Makefile

## For developers

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

mutants: deps  ## see that the tests notice errors: 200 small ones are built in, one at a time (minutes)
	@$(parallel) tests
	@scripts/mutants.py

format:  ## lay out all C files as `make style` wants them
	$(quiet)clang-format -i $(c_files)

compile_commands.json: $(B)/libraries Makefile  ## tell editors how each file is compiled
	@for file in $(filter %.c,$(c_files)); do \
	    echo "$$file" $(call quoted,$(CC) $(shoal_cppflags) $(version_cppflags) -iquote tests $(shoal_cflags) -c); \
	done | sed 's/["\\]/\\&/g; s|\([^ ]*\) \(.*\)|{"directory": "$(CURDIR)", "file": "\1", "command": "\2 \1"}|; 1s/^/[/; $$!s/$$/,/; $$s/$$/]/' >$@

docs: $(generated_docs)  ## write cases.md, output.md and case.schema.json in doc from the tables of the program
	$(quiet)cp $^ doc/

deps:  ## install the packages that are missing (nothing to do: no output)
	@scripts/install-deps.sh

## Installation: prefix=/usr/local libdir=$prefix/lib DESTDIR=

install: $(program) $(library) $(shared) $(manual) $(completion)  ## install program, library, header, module, cases, scripts, documents
	$(say) INST '$(DESTDIR)$(prefix)'
	$(quiet)install -d $(addprefix '$(DESTDIR)$(prefix)'/,bin include share/man/man1 share/man/man5 share/bash-completion/completions $(addprefix share/shoal/,cases/article cases/include cases/studies scripts doc))
	$(quiet)install -m 755 $(program) '$(DESTDIR)$(prefix)/bin'
	$(quiet)install -m 644 include/shoal.h '$(DESTDIR)$(prefix)/include'
	$(quiet)install -d '$(DESTDIR)$(libdir)/pkgconfig'
	$(quiet)install -m 644 $(library) '$(DESTDIR)$(libdir)'
	$(quiet)install -m 755 $(shared) '$(DESTDIR)$(libdir)/libshoal.so.$(VERSION)'
	$(quiet)ln -sf libshoal.so.$(VERSION) '$(DESTDIR)$(libdir)/$(soname)'
	$(quiet)ln -sf $(soname) '$(DESTDIR)$(libdir)/libshoal.so'
	$(quiet)install -m 644 cases/*.yaml '$(DESTDIR)$(prefix)/share/shoal/cases'
	$(quiet)install -m 644 cases/article/*.yaml '$(DESTDIR)$(prefix)/share/shoal/cases/article'
	$(quiet)install -m 644 cases/include/*.yaml '$(DESTDIR)$(prefix)/share/shoal/cases/include'
	$(quiet)install -m 644 cases/studies/*.yaml cases/studies/*.csv '$(DESTDIR)$(prefix)/share/shoal/cases/studies'
	$(quiet)install -m 755 $(filter-out scripts/make-% scripts/verify.py scripts/documents.py scripts/figures.py scripts/drawings.py scripts/mutants.py scripts/article.py,$(wildcard scripts/*.py)) '$(DESTDIR)$(prefix)/share/shoal/scripts'
	$(quiet)install -d '$(DESTDIR)$(python_modules)/shoal' '$(DESTDIR)$(prefix)/share/shoal/doc/'{examples,figures/gallery}
	$(quiet)rm -f '$(DESTDIR)$(python_modules)/shoal.py'
	$(quiet)install -m 644 scripts/shoal/*.py '$(DESTDIR)$(python_modules)/shoal'
	$(quiet)install -m 755 doc/examples/*.py '$(DESTDIR)$(prefix)/share/shoal/doc/examples'
	$(quiet)install -m 644 doc/figures/*.png doc/figures/*.gif '$(DESTDIR)$(prefix)/share/shoal/doc/figures'
	$(quiet)install -m 644 doc/figures/gallery/*.png '$(DESTDIR)$(prefix)/share/shoal/doc/figures/gallery'
	$(quiet)ln -sfn '$(patsubst $(prefix)/%,../../../%,$(python_modules))/shoal' '$(DESTDIR)$(prefix)/share/shoal/scripts/shoal'
	$(quiet)install -m 644 $(filter %.1,$(manual)) '$(DESTDIR)$(prefix)/share/man/man1'
	$(quiet)install -m 644 $(filter %.5,$(manual)) '$(DESTDIR)$(prefix)/share/man/man5'
	$(quiet)install -m 644 $(completion) '$(DESTDIR)$(prefix)/share/bash-completion/completions/shoal'
	$(quiet)install -m 644 LICENSE CITATION.cff CHANGES.md doc/*.md doc/shoal.ipynb doc/case.schema.json '$(DESTDIR)$(prefix)/share/shoal/doc'
	$(quiet)printf '%s\n' 'prefix=$(prefix)' 'libdir=$(libdir)' 'Name: shoal' 'Description: Swimming of fish and schools with their wakes' \
	    'Version: $(VERSION)' 'Cflags: -I$${prefix}/include' 'Libs: -L$${libdir} -lshoal' \
	    'Libs.private: $(libraries) $(if $(is_clang),$(shell $(CC) -print-file-name=libomp.so),-fopenmp)' \
	    >'$(DESTDIR)$(libdir)/pkgconfig/shoal.pc'
	@$(if $(DESTDIR),,$(PYTHON) -c 'import sys; sys.exit("$(python_modules)" not in sys.path)' || \
	    echo "for 'import shoal': export PYTHONPATH=$(python_modules)")

uninstall:  ## remove what `make install` installed
	$(quiet)rm -f $(addprefix '$(DESTDIR)$(prefix)'/,bin/shoal include/shoal.h)
	$(quiet)rm -f $(addprefix '$(DESTDIR)$(libdir)'/,libshoal.a libshoal.so $(soname) libshoal.so.$(VERSION) pkgconfig/shoal.pc)
	$(quiet)rm -f $(addprefix '$(DESTDIR)$(prefix)'/share/,man/man1/shoal.1 man/man5/shoal-case.5 man/man5/shoal-output.5 bash-completion/completions/shoal)
	$(quiet)rm -rf '$(DESTDIR)$(python_modules)/shoal'
	$(quiet)rm -rf '$(DESTDIR)$(prefix)/share/shoal'

deb: deps  ## build the packages of Debian in build/deb, and let lintian check them
	@scripts/install-deps.sh build-essential debhelper dh-python lintian
	@scripts/packaging/make-deb.sh $(B)/deb $(VERSION)

# ---- rules ----

$(program): $(app_objects) $(objects)
	$(say) LD $@
	$(quiet)$(CC) $(shoal_cflags) $(LDFLAGS) -o $@ $^ $(static_gomp) $(libraries)

$(objects): $(library_objects)
	$(say) AR $@
	$(quiet)rm -f $@
	$(quiet)$(AR) rcs $@ $^

# one object in which every other name is local: a program that links it may use those names for itself
$(B)/libshoal.o: $(library_objects)
	$(say) LD $@
	$(quiet)$(LD) -r -o $@ $^
	$(quiet)objcopy --wildcard --keep-global-symbol='shoal_*' $@

$(library): $(B)/libshoal.o
	$(say) AR $@
	$(quiet)rm -f $@
	$(quiet)$(AR) rcs $@ $^

$(shared): $(library_objects) src/library/shoal.map
	$(say) LD $@
	$(quiet)$(CC) $(shoal_cflags) $(LDFLAGS) -shared -Wl,-soname,$(soname) -Wl,--version-script=src/library/shoal.map \
	    $(complete) -o $@ $(library_objects) $(libraries)

# again when the compiler or one of these variables is another one
library_variables = CC CPPFLAGS LDFLAGS PKG_CONFIG_PATH CONDA_PREFIX $(addsuffix _DIR,SUNDIALS SUITESPARSE NETCDF LAPACKE YAML ZLIB)
configuration = $(foreach variable,$(library_variables),$(variable)='$(filter-out ccache,$($(variable)))')
$(B)/configuration: FORCE | $(folders)
	@echo "$(configuration)" | cmp -s - $@ || echo "$(configuration)" >$@

$(B)/libraries: $(B)/configuration scripts/find-libraries.sh
	$(say) FIND '$(B)/libraries'
	$(quiet)$(configuration) scripts/find-libraries.sh $(B) $(CC)

quoted = '$(subst ','\'',$(1))'

# warnings are kept for `make style`
compile = $(CC) $(shoal_cppflags) $(shoal_cflags) -MMD -MP -c -o $@ $< 2> >(tee $(@:.o=.warnings) >&2)

$(B)/%.o: src/%.c Makefile $(B)/libraries | $(folders)
	$(say) CC $<
	$(quiet)$(compile)

version_cppflags = -DSHOAL_VERSION='"$(VERSION)"' -DSHOAL_COMMIT='"$(commit)"'
$(B)/base/version.o: shoal_cppflags += $(version_cppflags)
$(B)/base/version.o: $(B)/commit

$(B)/view/page.o: src/view/page.html
$(B)/view/page.o: shoal_cflags += -Wa,-I$(abspath src/view)

# rewritten only when the commit changes
$(B)/commit: FORCE | $(folders)
	@echo '$(commit)' | cmp -s - $@ || echo '$(commit)' >$@

$(B)/fuzz/%.o: tests/fuzz/%.c Makefile $(B)/libraries | $(folders)
	$(say) CC $<
	$(quiet)$(compile)

$(B)/fuzz/%: $(B)/fuzz/%.o $(if $(FUZZER),,$(B)/fuzz/driver.o) $(objects)
	$(say) LD $@
	$(quiet)$(CC) $(shoal_cflags) $(if $(FUZZER),-fsanitize=fuzzer) $(LDFLAGS) -o $@ $^ $(libraries)

# to be preloaded: tests/soak/faults.py, memory.py, power.py
faults = $(B)/files.so $(B)/memory.so
$(faults): $(B)/%.so: tests/faults/%.c
$(faults): Makefile | $(folders)
	$(say) LD $@
	$(quiet)$(CC) -std=c11 -Wall -Wextra -Wconversion -Wshadow -Wcast-qual $(if $(WERROR),-Werror) -O2 -shared -fPIC -o $@ $(filter %.c,$^)

tests: all $(faults) $(fuzz_programs) $(c_tests) $(verify_program) $(bench_programs)

$(B)/verify/%.o: tests/verify/%.c Makefile $(B)/libraries | $(folders)
	$(say) CC $<
	$(quiet)$(compile)

$(verify_program): $(verify_objects) $(objects)
	$(say) LD $@
	$(quiet)$(CC) $(shoal_cflags) $(LDFLAGS) -o $@ $^ $(libraries)

$(B)/bench/%.o: tests/bench/%.c Makefile $(B)/libraries | $(folders)
	$(say) CC $<
	$(quiet)$(compile)

$(B)/tests/%.o: shoal_cppflags += -iquote tests
$(B)/tests/%.o: tests/%.c Makefile $(B)/libraries | $(folders)
	$(say) CC $<
	$(quiet)$(compile)

# A program that defines __wrap_calloc receives every calloc of the library, and finds the true one as __real_calloc.
wrapped = $$(nm $(filter %.o,$^) | sed -n 's/.* T __wrap_\(.*\)/-Wl,--wrap=\1/p')

$(B)/bench/%: $(B)/bench/%.o $(objects)
	$(say) LD $@
	$(quiet)$(CC) $(shoal_cflags) $(LDFLAGS) $(wrapped) -o $@ $^ $(libraries)

$(c_tests): %: %.o $(test_helpers) $(objects)
	$(say) LD $@
	$(quiet)$(CC) $(shoal_cflags) $(LDFLAGS) $(wrapped) -o $@ $^ -lcmocka $(libraries)

$(B)/doc/cases.md: $(program) scripts/make-cases-doc.py | $(folders)
	$(quiet)$(program) keys --json | $(PYTHON) scripts/make-cases-doc.py >$@

$(B)/doc/case.schema.json: $(program) scripts/make-schema.py | $(folders)
	$(quiet)$(program) keys --json | $(PYTHON) scripts/make-schema.py >$@

$(B)/doc/shoal.1: $(program) scripts/make-man.py | $(folders)
	$(quiet)$(program) --describe | $(PYTHON) scripts/make-man.py shoal.1 >$@

$(B)/doc/shoal-case.5: $(program) scripts/make-man.py | $(folders)
	$(quiet)$(program) keys --json | $(PYTHON) scripts/make-man.py shoal-case.5 >$@

$(B)/doc/shoal-output.5: $(program) scripts/make-man.py | $(folders)
	$(quiet)$(program) keys --output --json | $(PYTHON) scripts/make-man.py shoal-output.5 >$@

$(completion): $(program) scripts/make-completion.py | $(folders)
	$(quiet)$(PYTHON) scripts/make-completion.py <($(program) --describe) <($(program) keys --json) >$@

$(B)/doc/output.md: $(program) scripts/make-output-doc.py | $(folders)
	$(quiet)$(program) keys --output --json | $(PYTHON) scripts/make-output-doc.py >$@

$(folders):
	@mkdir -p $@

.PRECIOUS: $(B)/tests/%.o $(B)/bench/%.o $(B)/fuzz/%.o
-include $(wildcard $(B)/*/*.d $(B)/tests/*/*.d)
