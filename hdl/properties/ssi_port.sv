// rests_high: The clock is HIGH whenever no frame is under way, after its last rising edge and within the recovery time.
// one_result: A trigger outside a frame has exactly one result, and no result comes without a trigger.
// only_on_high: The clock falls for the first time only for a trigger, with DATA HIGH and a kind of frame that is allowed.
// waits_after_reset: After a reset, and after a frame with DATA HIGH at its end, no frame begins before the longest recovery time has passed, whatever DATA is.
// good_is_whole: A position is taken only if DATA was HIGH before the frame and LOW after it, all bits have come, its parity bit fits, and both copies are the same.
// withdrawn: If DATA is still LOW when the longest recovery time is over, no position is valid, and there is a cause. A frame that brought none withdraws none.
reg f_owed; initial f_owed = 1'b0;
reg f_past_valid; initial f_past_valid = 1'b0;
// after a reset, before the first trigger
wire f_begins = unknown & not_low;
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    if (publishes) f_owed <= 1'b0;
    if (trigger & (state == AT_REST)) f_owed <= 1'b1;
    if (reset) f_owed <= 1'b0;
end
always @(posedge clock) if (f_past_valid & !$past(reset)) begin
    if ($past((state == AT_RECOVERY) & is_due & !filter_level & good)) withdrawn: assert (!fresh & !position_valid & ((cause == 5'd8) | (cause == 5'd6)));
    if ($past(position_valid) & !position_valid) withdrawn_only: assert (($past((state == AT_RECOVERY) & is_due & !filter_level) & $past(!(|found))) | (cause == 5'd6));
    if ((state == AT_LOW) & $past(state == AT_REST)) only_on_high: assert ($past(trigger & filter_level & frame[2]));
    if ((state == AT_REST) & $past(state != AT_REST)) waits_after_reset: assert ($past((state == AT_RECOVERY) & (is_due | (filter_level & !not_low))));
    if ((state == AT_RECOVERY) & $past(state != AT_RECOVERY)) waits_after_reset_judged: assert ($past(state == AT_JUDGE));
    if ((state == AT_JUDGE) & $past(state == AT_LAST)) waits_after_reset_whole: assert ($past(is_due & !first) & (timer == $past(recovery_limit_cycles)));
    if ((state == AT_LAST) & $past((state == AT_LAST) & is_due)) waits_after_reset_period: assert ($past(first) & !first & (timer == {2'd0, $past(period)} - 13'd1));
    if ((state == AT_RECOVERY) & $past((state == AT_JUDGE) | (state == AT_RECOVERY))) waits_after_reset_counts: assert ($past(is_due) | (timer == $past(timer) - 13'd1));
end
always @(posedge clock) if (f_past_valid & $past(reset))
    waits_after_reset_begins: assert ((state == AT_LAST) & first & f_begins & clk);
wire f_runs = (state == AT_LOW) | (state == AT_HIGH) | (state == AT_LAST);
always @* begin
    rests_high: assert (clk ^ (state == AT_LOW));
    rests_high_states: assert (f_runs | (state == AT_REST) | (state == AT_JUDGE) | (state == AT_RECOVERY));
    one_result: assert (f_owed == ((f_runs | (state == AT_JUDGE)) & !f_begins));
    one_result_once: assert (!publishes | f_owed);
    one_result_runs: assert (!(f_runs & unknown) | ((state == AT_LAST) & not_low));
    waits_after_reset_first: assert ((state != AT_LAST) | !first | f_begins);
    good_is_whole: assert (!snapshot_good | (!not_high & !not_low & !unknown & !not_even & (left == 6'd0) & (second == frame[1]) & (!frame[1] | (word == again))));
end
// with HAS_GUARDS
// counted_twice: Both counts of bits are equal, and so are both marks of the edge that brings no bit.
// as_it_came: The stored bits are the received bits: both have the same sum, unless there were more than 48.
reg f_full; initial f_full = 1'b0;
always @(posedge clock) begin
    if (takes_bit & !is_parity & !second & word[47]) f_full <= 1'b1;
    if ((trigger & (state == AT_REST)) | reset) f_full <= 1'b0;
end
always @* begin
    counted_twice: assert ((left == left_too) & (first == first_too) & !torn);
    as_it_came: assert (f_full | ((^word) == sum));
end
// end
