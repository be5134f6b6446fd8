# SPDX-License-Identifier: MIT
#
# Rules for make: "include .../nmtan.mk" after setting what differs. OUT/name.glb is made of IN/name.obj, .ply, .gltf or
# .glb, and again when a file changes that it was made of; say which outputs are wanted:
#
#     all: $(NMTAN_OUT)/a.glb $(NMTAN_OUT)/props/b.glb
#
# make has no way with blanks, quotes and "%" in names of pattern rules. The target nmtan-update makes what is needed of
# all meshes below IN, whatever they are called, in one process and with all processors.
NMTAN ?= nmtan
NMTAN_IN ?= assets
NMTAN_OUT ?= out
NMTAN_FLAGS ?=

# Another program makes other outputs.
nmtan_program := $(shell command -v $(NMTAN) 2>/dev/null)

define nmtan_rule
$(NMTAN_OUT)/%.glb: $(NMTAN_IN)/%.$(1) $(nmtan_program)
	@mkdir -p $$(@D)
	$(NMTAN) -q $(NMTAN_FLAGS) --depfile=$$@.d $$< $$@
endef
$(foreach ending,obj ply gltf glb,$(eval $(call nmtan_rule,$(ending))))

# Files that existing outputs were made of. An output gets a new time even where its bytes stay, or make would make it
# again for ever.
-include $(shell [ ! -d $(NMTAN_OUT) ] || find $(NMTAN_OUT) -name '*.glb.d')

.PHONY: nmtan-update
nmtan-update:
	$(NMTAN) --update -r -d $(NMTAN_OUT) --keep-tree=$(NMTAN_IN) $(NMTAN_FLAGS) $(NMTAN_IN)
