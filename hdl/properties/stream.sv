// one_set_per_trigger: A trigger while sets are collected has exactly one set, or is counted as lost; nothing else makes a set.
// set_head_constant: Number, time and count of lost ones in the head of a set do not change while its frame is being written.
// lost_counted: Each lost set is counted, up to 65535, until the host clears the count; the sets lost before a set are counted up to 255.
reg f_owed; initial f_owed = 1'b0;
reg f_same; initial f_same = 1'b0;
reg f_past_valid; initial f_past_valid = 1'b0;
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    f_same <= f_past_valid & !reset & !$past(reset) & $past(!buffer_idle) & $stable({block, byte_at});
    if (take_now | lost_now) f_owed <= 1'b0;
    if (trigger & collect) f_owed <= 1'b1;
    if (reset) f_owed <= 1'b0;
end
always @* begin
    one_set_per_trigger: assert (!(take_now & lost_now) & (!(take_now | lost_now) | f_owed) & (!(f_owed & trigger) | take_now | lost_now));
    one_set_per_trigger_open: assert (f_owed == open);
end
always @(posedge clock) if (f_past_valid & !$past(reset)) begin
    if ($past(!buffer_idle)) set_head_constant: assert ($stable({sequence_taken, time_taken, lost_taken}));
    if ($past(lost_now & !clear & !(&lost_all))) lost_counted: assert (lost_all == $past(lost_all) + 16'd1);
    if ($past(!lost_before_reset)) lost_counted_before: assert ((lost_before >= $past(lost_before)) & (!$past(lost_now & (lost_before != 8'hff)) | (lost_before == $past(lost_before) + 8'd1)));
    if (f_same & $past(!buffer_idle)) set_head_constant_bytes: assert ($stable(head_byte));
end
