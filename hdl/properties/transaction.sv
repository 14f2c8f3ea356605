// starts_at_rest: A frame starts only when the line was ready: idle, and DATA LOW.
// low_for_tr: The line is ready only after DATA was LOW for tR.
// abort_pause: After an aborted frame CLOCK does not change for 30 ms, less three microseconds, before DATA is checked again.
// one_result_per_trigger unless HAS_ALL (requests), HAS_CONTINUOUS (continuous clock): Every trigger has exactly one result, or is reported as lost; nothing else has a result.
reg f_past_valid; initial f_past_valid = 1'b0;
reg [15:0] f_low_cycles; initial f_low_cycles = 16'd0;
reg [15:0] f_quiet_us; initial f_quiet_us = 16'd0;
wire f_quiet = (phase == PHASE_ABORT) & !leaving & !probing & !settling;
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    f_low_cycles <= (level | reset) ? 16'd0 : (&f_low_cycles) ? f_low_cycles : f_low_cycles + 16'd1;
    f_quiet_us <= (!f_quiet | aborts | reset) ? 16'd0 : (tick_us & !(&f_quiet_us)) ? f_quiet_us + 16'd1 : f_quiet_us;
end
reg f_owed; initial f_owed = 1'b0;
reg f_lost; initial f_lost = 1'b0;
reg f_tells; initial f_tells = 1'b0;
wire f_taken = trigger & !lost;
wire f_in_frame = (phase == PHASE_FIRST_LOW) | (phase == PHASE_FRAME) | (phase == PHASE_TAIL) | (phase == PHASE_RECOVERY) | (phase == PHASE_PARK);
always @(posedge clock) begin
    f_lost <= lost & !reset;
    f_tells <= !reset & (refuse | announce | (give_up & !aborts & !((answered & !verdict_once_more) | found_late)));
    f_owed <= !reset & (f_taken | (f_owed & !publish));
end
`ifndef FORMAL_ANY_STATE
// requests have separate frames, and a continuous clock has results without triggers
always @* if (!HAS_ALL & !HAS_CONTINUOUS) begin
    one_result_per_trigger: assert (!f_taken | !f_owed | publish);
    one_result_per_trigger_asked: assert (!publish | f_owed);
    one_result_per_trigger_lost: assert (displaced == f_lost);
    one_result_per_trigger_at_rest: assert ((phase != PHASE_READY) | !f_owed | owed | f_tells | publish | give_up);
    one_result_per_trigger_lemma_rest: assert (f_in_frame | !(under_way | answered));
    one_result_per_trigger_lemma_frame: assert (!f_in_frame | owing | answered);
    one_result_per_trigger_lemma_once: assert (!answered | !verdict_is_pending | verdict_publishes | verdict_once_more | aborts);
    one_result_per_trigger_lemma_where: assert (!answered | aborts | (phase == PHASE_RECOVERY) | (late & (phase == PHASE_FRAME)));
    one_result_per_trigger_lemma_tail: assert ((phase != PHASE_TAIL) | verdict_is_pending | aborts);
    one_result_per_trigger_lemma_sampled: assert (!tail_sampled | starting | !f_in_frame | (phase == PHASE_RECOVERY));
    one_result_per_trigger_lemma_proved: assert ((phase != PHASE_RECOVERY) | aborts | !owing | (tail_sampled ? answered | once_more | verdict_once_more : verdict_is_pending));
    one_result_per_trigger_lemma_told: assert (!answered | !owing | verdict_publishes | verdict_once_more | f_tells | aborts);
    one_result_per_trigger_lemma_result: assert (!(verdict_publishes | verdict_once_more) | answered | f_tells | aborts);
    one_result_per_trigger_lemma_pending: assert (!verdict_is_pending | f_in_frame | aborts);
    one_result_per_trigger_lemma_single: assert (!(verdict_is_pending & f_tells) | aborts);
    one_result_per_trigger_lemma_after: assert (!((phase == PHASE_RECOVERY) & tail_sampled & verdict_is_pending) | verdict_publishes | verdict_once_more | aborts);
    one_result_per_trigger_lemma_owing: assert (f_in_frame | !owing | once_more | aborts | publish);
    one_result_per_trigger_lemma_open: assert (f_owed == (owing | f_tells | publish));
end
always @(posedge clock) if (f_past_valid & !$past(reset)) begin
    starts_at_rest: assert (!starting | (($past(phase) == PHASE_READY) & !$past(level)));
end
always @* begin
    low_for_tr: assert ((phase != PHASE_READY) | (f_low_cycles >= READY_LOW_CYCLES));
    low_for_tr_lemma_timer: assert ((phase != PHASE_NOT_READY) | cleared | (timer < f_low_cycles) | (&f_low_cycles));
    low_for_tr_lemma_start: assert (!starting | (phase == PHASE_FIRST_LOW) | (phase == PHASE_FRAME) | (phase == PHASE_ABORT));
    low_for_tr_lemma_back: assert (!is_back | (phase == PHASE_RECOVERY) | (phase == PHASE_ABORT));
    low_for_tr_lemma_limit: assert ((phase != PHASE_NOT_READY) | cleared | (timer_limit == READY_LOW_CYCLES - 16'd1));
    low_for_tr_lemma_hit: assert ((phase != PHASE_NOT_READY) | !timer_hit | (f_low_cycles >= READY_LOW_CYCLES));
    abort_pause: assert (!f_quiet | aborts | (phase_next != PHASE_NOT_READY) | (f_quiet_us >= ABORT_US - 16'd3));
    abort_pause_lemma_timer: assert (!f_quiet | cleared | ({1'b0, timer} + {16'd0, timer_step} <= {1'b0, f_quiet_us} + 17'd3));
    abort_pause_lemma_limit: assert (!f_quiet | cleared | (timer_limit == ABORT_US));
    abort_pause_lemma_hit: assert (!f_quiet | !timer_hit | (f_quiet_us >= ABORT_US - 16'd3));
end
`endif
`ifdef FORMAL_ANY_STATE
// forward_only unless HAS_ALL (requests), HAS_DIAGNOSIS (diagnosis), HAS_CONTINUOUS (continuous clock): Without a new trigger the phase of a frame only advances, or goes to the abort, from any register contents.
// phases_are_timed unless HAS_ALL (requests), HAS_DIAGNOSIS (diagnosis), HAS_CONTINUOUS (continuous clock): Every phase has a timer that counts to the limit of this phase.
// phases_end unless HAS_ALL (requests), HAS_DIAGNOSIS (diagnosis), HAS_CONTINUOUS (continuous clock): A phase ends when its timer reaches the limit.
function [2:0] f_rank (input [2:0] of);
    case (of)
        PHASE_FIRST_LOW: f_rank = 3'd5;
        PHASE_FRAME: f_rank = 3'd4;
        PHASE_PARK: f_rank = 3'd6;
        PHASE_TAIL: f_rank = 3'd3;
        PHASE_RECOVERY: f_rank = 3'd2;
        PHASE_ABORT: f_rank = 3'd1;
        default: f_rank = 3'd0;
    endcase
endfunction
// a supplement, a continuous clock and the diagnosis of the line lead back on purpose; no trigger, or a new frame begins
wire f_plain = !HAS_ALL & !HAS_DIAGNOSIS & !HAS_CONTINUOUS;
wire f_restarts = ((phase == PHASE_FRAME) & ((hunting ^ was_hunting) | finished)) | rise_back;
wire f_timed = (f_rank(phase) != 3'd0) & !aborts & !((phase == PHASE_ABORT) & timer_hit) & !f_restarts & !cleared & !is_back & !starting;
always @(posedge clock) if (f_past_valid & f_plain & !$past(reset) & !$past(trigger | owed)) begin
    forward_only: assert ((f_rank(phase) <= f_rank($past(phase))) | $past(aborts));
    if ($past(aborts)) forward_only_abort: assert (phase == PHASE_ABORT);
    if ((phase == $past(phase)) & $past(f_timed)) begin
        phases_are_timed: assert (timer == $past(timer) + {15'd0, $past(timer_step)});
        phases_are_timed_to_the_end: assert (timer_hit == (($past(timer) >= $past(timer_limit)) & !$past(cleared)));
    end
    if (phase == $past(phase) & (f_rank(phase) != 3'd0)) begin
        if (phase == PHASE_ABORT) phases_are_timed_abort: assert (timer_limit == ABORT_US);
        if (phase == PHASE_RECOVERY & !is_own) phases_are_timed_recovery: assert ((timer_limit == $past({3'd0, recovery_limit_cycles})) | $past(own));
        if (phase == PHASE_FRAME) phases_are_timed_frame: assert (timer_limit == $past({4'd0, start_timeout_us}));
    end
    if (!$past(aborts)) begin
        if (($past(phase) == PHASE_ABORT) & $past(timer_hit) & !$past(probing)) phases_end_abort: assert (phase == PHASE_NOT_READY);
        if (($past(phase) == PHASE_FIRST_LOW) & $past(timer_hit)) phases_end: assert (phase == PHASE_FRAME);
        if (($past(phase) == PHASE_RECOVERY) & $past(timer_hit)) phases_end_recovery: assert ((phase == PHASE_NOT_READY) | aborts);
        if ($past(phase) == PHASE_PARK) phases_end_park: assert (aborts | (phase != PHASE_PARK));
        if (($past(phase) == PHASE_TAIL) & $past(was_center)) phases_end_tail: assert (phase == PHASE_RECOVERY);
        if ((($past(phase) == PHASE_FRAME) | ($past(phase) == PHASE_TAIL)) & $past(timer[12]) & !(($past(phase) == PHASE_FRAME) & $past(hunting)))
            phases_end_watchdog: assert (aborts | (phase != $past(phase)));
        if (($past(phase) == PHASE_FRAME) & $past(timer_hit & hunting & was_hunting)) phases_end_hunting: assert (aborts | (phase != PHASE_FRAME));
    end
end
`endif
