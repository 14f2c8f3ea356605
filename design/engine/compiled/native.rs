//! Native code for a form, made by Cranelift. All `unsafe` of the engines is here.

use super::layout::Layout;
use crate::engine::form::Form;
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::types::I64;
use cranelift_codegen::ir::{
    AbiParam, Block, BlockCall, InstBuilder, JumpTableData, MemFlagsData, TrapCode, Type,
    UserFuncName, Value,
};
use cranelift_codegen::settings::{self, Configurable};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{FuncId, Linkage, Module, ModuleError};
use std::ops::Range;
use std::sync::{Arc, Mutex};

/// Code of designs with fewer segments is verified before it is made, in builds with assertions.
const CHECKED_SEGMENTS: usize = 300;

/// How values are held: one machine word for each net, or one bit of many copies.
pub(in crate::engine) trait Lower {
    /// Emits what a segment computes and stores. Nets with the condition, not 0 if one of them has changed.
    fn segment(&self, code: &mut Code<'_, '_>, segment: usize) -> Vec<(Vec<usize>, Value)>;
    /// Emits the loading of a group of registers, likewise.
    fn group(&self, code: &mut Code<'_, '_>, group: usize) -> Vec<(Vec<usize>, Value)>;
}

/// Code in the making.
pub(in crate::engine) struct Code<'a, 'f> {
    pub builder: &'a mut FunctionBuilder<'f>,
    pub layout: &'a Layout,
    state: Value,
}

impl Code<'_, '_> {
    /// Flags of accesses to the state: they never fault, and are aligned to at most a word.
    fn flags() -> MemFlagsData {
        MemFlagsData::new().with_notrap()
    }

    /// Loads a value of any type from a word of the state.
    pub fn load(&mut self, kind: Type, word: usize) -> Value {
        self.check(kind, word);
        let (state, offset) = (self.state, Self::offset(word));
        self.builder.ins().load(kind, Self::flags(), state, offset)
    }

    /// Stores a value at a word of the state.
    pub fn store(&mut self, value: Value, word: usize) {
        let kind = self.builder.func.dfg.value_type(value);
        self.check(kind, word);
        let (state, offset) = (self.state, Self::offset(word));
        self.builder
            .ins()
            .store(Self::flags(), value, state, offset);
    }

    /// Every access of the code that is made lies within the state: this is checked here, once, not when it runs.
    fn check(&self, kind: Type, word: usize) {
        let end = word + kind.bytes().div_ceil(8) as usize;
        assert!(end <= self.layout.words, "word {word} is not in the state");
    }

    fn offset(word: usize) -> i32 {
        i32::try_from(word * 8).unwrap_or_else(|_| unreachable!("a state of 2 GB"))
    }

    /// Sets the bits of all readers of nets that have changed.
    fn mark(&mut self, changes: &[(Vec<usize>, Value)]) {
        let mut sums: Vec<(usize, Value)> = vec![];
        for (nets, condition) in changes {
            let mut marks: Vec<(usize, u64)> = vec![];
            for (word, bits) in nets.iter().flat_map(|net| self.layout.marks(*net)) {
                match marks.iter_mut().find(|(w, _)| w == word) {
                    Some((_, all)) => *all |= bits,
                    None => marks.push((*word, *bits)),
                }
            }
            let zero = self.builder.ins().iconst(I64, 0);
            for (word, bits) in marks {
                let bits = self.builder.ins().iconst(I64, bits.cast_signed());
                let bits = self.builder.ins().select(*condition, bits, zero);
                match sums.iter_mut().find(|(w, _)| *w == word) {
                    Some((_, sum)) => *sum = self.builder.ins().bor(*sum, bits),
                    None => sums.push((word, bits)),
                }
            }
        }
        for (word, bits) in sums {
            let old = self.load(I64, word);
            let new = self.builder.ins().bor(old, bits);
            self.store(new, word);
        }
    }

    /// Emits: for every bit that is set in `words`, lowest first, clear it and run `part` of its number.
    fn for_each_set_bit(
        &mut self,
        words: Range<usize>,
        count: usize,
        part: impl Fn(&mut Self, usize) -> Vec<(Vec<usize>, Value)>,
    ) {
        for (index, word) in words.enumerate() {
            let (head, found) = (self.builder.create_block(), self.builder.create_block());
            let next = self.builder.create_block();
            self.builder.ins().jump(head, &[]);
            self.builder.switch_to_block(head);
            let bits = self.load(I64, word);
            self.builder.ins().brif(bits, found, &[], next, &[]);
            self.builder.switch_to_block(found);
            let lowest = self.builder.ins().ctz(bits);
            let less = self.builder.ins().iadd_imm_s(bits, -1);
            let rest = self.builder.ins().band(bits, less);
            self.store(rest, word);
            let parts: Vec<usize> = (64 * index..count.min(64 * index + 64)).collect();
            let blocks: Vec<Block> = parts.iter().map(|_| self.builder.create_block()).collect();
            let number = self
                .builder
                .ins()
                .ireduce(cranelift_codegen::ir::types::I32, lowest);
            self.jump_to(number, &blocks);
            for (number, block) in parts.into_iter().zip(blocks) {
                self.builder.switch_to_block(block);
                let changes = part(self, number);
                self.mark(&changes);
                self.builder.ins().jump(head, &[]);
            }
            self.builder.switch_to_block(next);
        }
    }

    fn jump_to(&mut self, number: Value, blocks: &[Block]) {
        let never = self.builder.create_block();
        let pool = &mut self.builder.func.dfg.value_lists;
        let calls: Vec<BlockCall> = blocks
            .iter()
            .map(|block| BlockCall::new(*block, [], pool))
            .collect();
        let default = BlockCall::new(never, [], pool);
        let table = self
            .builder
            .create_jump_table(JumpTableData::new(default, &calls));
        self.builder.ins().br_table(number, table);
        self.builder.switch_to_block(never);
        self.builder.ins().trap(TrapCode::unwrap_user(1));
    }

    /// Whether a number is not 0.
    pub fn is_not_zero(&mut self, value: Value) -> Value {
        self.builder.ins().icmp_imm_s(IntCC::NotEqual, value, 0)
    }
}

/// Machine code of one design.
#[derive(Clone)]
pub(in crate::engine) struct Native {
    settle: extern "C" fn(*mut u64),
    commit: extern "C" fn(*mut u64),
    words: usize,
    _memory: Arc<CodeMemory>,
}

/// Keeps the machine code until nobody can call it any more.
struct CodeMemory(Mutex<Option<JITModule>>);

impl Drop for CodeMemory {
    #[allow(unsafe_code)]
    fn drop(&mut self) {
        if let Some(module) = self.0.get_mut().ok().and_then(Option::take) {
            // SAFETY: the only pointers into the code are in `Native`, each together with a reference to this.
            unsafe { module.free_memory() };
        }
    }
}

/// Checks for native code on this machine; without it engines use an interpreter.
///
/// # Errors
/// The reason from the code generator.
pub fn has_native_code() -> Result<(), String> {
    cranelift_native::builder().map(drop).map_err(str::to_owned)
}

impl Native {
    /// Compiles a form.
    ///
    /// # Errors
    /// The error of the code generator, if it does not support this platform.
    pub fn compile(form: &Form, layout: &Layout, lower: &dyn Lower) -> Result<Self, String> {
        let mut flags = settings::builder();
        let set = [
            ("opt_level", "speed"),
            ("use_colocated_libcalls", "false"),
            ("is_pic", "false"),
        ];
        for (name, value) in set {
            flags.set(name, value).map_err(|e| e.to_string())?;
        }
        // The same few rules make all code: a small design shows a wrong one, and a large one would take long.
        let is_checked = cfg!(debug_assertions) && form.segments.len() < CHECKED_SEGMENTS;
        if !is_checked {
            flags
                .set("enable_verifier", "false")
                .map_err(|e| e.to_string())?;
        }
        let isa = cranelift_native::builder().map_err(str::to_owned)?;
        let isa = isa
            .finish(settings::Flags::new(flags))
            .map_err(|e| e.to_string())?;
        let builder = JITBuilder::with_isa(isa, cranelift_module::default_libcall_names());
        let mut module = JITModule::new(builder);
        let settle = define(&mut module, "settle", layout, |code| {
            code.for_each_set_bit(layout.segment_words(), form.segments.len(), |code, n| {
                lower.segment(code, n)
            });
        });
        let commit = define(&mut module, "commit", layout, |code| {
            code.for_each_set_bit(layout.group_words(), layout.groups, |code, n| {
                lower.group(code, n)
            });
        });
        let (settle, commit) = (
            settle.map_err(|e| e.to_string())?,
            commit.map_err(|e| e.to_string())?,
        );
        module.finalize_definitions().map_err(|e| e.to_string())?;
        Ok(Self {
            settle: entry(&module, settle),
            commit: entry(&module, commit),
            words: layout.words,
            _memory: Arc::new(CodeMemory(Mutex::new(Some(module)))),
        })
    }

    /// Runs all segments that are marked, in order.
    pub fn settle(&self, state: &mut [u64]) {
        assert_eq!(state.len(), self.words);
        // The code touches nothing but these words: see `Code::check`.
        (self.settle)(state.as_mut_ptr());
    }

    /// Loads all groups of registers that are marked.
    pub fn commit(&self, state: &mut [u64]) {
        assert_eq!(state.len(), self.words);
        (self.commit)(state.as_mut_ptr());
    }
}

#[allow(unsafe_code)]
fn entry(module: &JITModule, id: FuncId) -> extern "C" fn(*mut u64) {
    let code = module.get_finalized_function(id);
    // SAFETY: `define` gave the function this signature and calling convention.
    unsafe { std::mem::transmute::<*const u8, extern "C" fn(*mut u64)>(code) }
}

fn define(
    module: &mut JITModule,
    name: &str,
    layout: &Layout,
    body: impl FnOnce(&mut Code<'_, '_>),
) -> Result<FuncId, Box<ModuleError>> {
    let mut context = module.make_context();
    let pointer = module.target_config().pointer_type();
    context.func.signature.params.push(AbiParam::new(pointer));
    context.func.name = UserFuncName::default();
    let mut memory = FunctionBuilderContext::new();
    let mut builder = FunctionBuilder::new(&mut context.func, &mut memory);
    let start = builder.create_block();
    builder.append_block_params_for_function_params(start);
    builder.switch_to_block(start);
    let state = builder.block_params(start)[0];
    body(&mut Code {
        builder: &mut builder,
        layout,
        state,
    });
    builder.ins().return_(&[]);
    builder.seal_all_blocks();
    builder.finalize(module.target_config());
    let id = module.declare_function(name, Linkage::Local, &context.func.signature);
    let id = id.map_err(Box::new)?;
    module.define_function(id, &mut context).map_err(Box::new)?;
    Ok(id)
}
